// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/dist/processes/homes.hpp>
#include <taut/impl/dist/ranges/line_layout.hpp>
#include <taut/impl/dist/ranges/ranged_volume.hpp>

namespace taut::dist::impl
{

/// A volume in a text, or in several, by lines.
class text_volume : public ranged_volume
{
public:
    /// Collective. Throws unsuited.
    text_volume(const communicator& all, line_layout layout) : ranged_volume(all), layout_(std::move(layout))
    {
        suited(all_, [this] { read(); });
        bound();
        if (vertices != layout_.vertices) throw unsuited("it has not one item a line");
        find_numbers();
        share_names();
        corners_ = places_of(std::move(corners_));
        finish_cells();
        numbers_.clear();
        numbers_.shrink_to_fit();
    }

    std::vector<std::int64_t> members(std::size_t group) const override
    {
        std::vector<std::int64_t> places, named;
        each(
            [&](const line_section& s, std::int64_t place, const tokens& w)
            {
                if (s.what == line_section::content::vertices && s.group && is(s.group(w), group))
                    places.push_back(s.first + place);
            },
            [&](const line_cell& c)
            {
                const auto n = static_cast<std::ptrdiff_t>(io::impl::shape_of(c.kind).corners);
                if (std::any_of(c.groups.begin(), c.groups.end(), [&](int k) { return is(k, group); }))
                    named.insert(named.end(), c.corners.begin(), c.corners.begin() + n);
            });
        std::sort(named.begin(), named.end());
        named.erase(std::unique(named.begin(), named.end()), named.end());
        const auto found = places_of(std::move(named));
        places.insert(places.end(), found.begin(), found.end());
        return at_home(std::move(places));
    }

    labelled_cells labelled() const override
    {
        bool first = false;
        const auto each_cell = [this](const auto& f) { each([](auto&&...) {}, f); };
        each_cell([&](const line_cell& c) { first = first || c.labels[0] != 0; });
        const std::size_t which = all_.any(first) ? 0 : 1;
        label_tuples labels(1);
        each_cell(
            [&](const line_cell& c)
            {
                const auto label = std::span(c.labels).subspan(which, 1);
                const auto corners = static_cast<std::size_t>(io::impl::shape_of(c.kind).corners);
                if (c.dimension() == 3) labels.add_cell(label);
                if (c.dimension() == 2) labels.add_face(std::span(c.corners).first(corners), label);
            });
        labels.replace_corners(places_of(labels.corners()));
        return labels.numbered(all_);
    }

    outputs write(const std::filesystem::path& path, const std::vector<vec3>& x) const override
    {
        outputs files;
        for (std::size_t k = 0; k < layout_.texts.size(); ++k)
        {
            auto name = path;
            if (!layout_.extensions.empty()) name.replace_extension(layout_.extensions[k]);
            std::string changed;
            all_.together(
                [&]
                {
                    if (k == 0) changed = with(x);
                });
            const std::string& text = k == 0 ? changed : layout_.texts[k]->text();
            const auto begin = static_cast<std::size_t>(all_.before(static_cast<std::int64_t>(text.size())));
            auto file = std::make_unique<shared_output>(all_, name);
            file->write(begin, text);
            file->close();
            files.push_back(std::move(file));
        }
        return files;
    }

private:
    using content = line_section::content;

    bool is(int local, std::size_t group) const
    {
        return local >= 0 && group_of_[static_cast<std::size_t>(local)] == static_cast<std::int64_t>(group);
    }

    /// Calls vertex(section, number, words) and cell(cell) for all lines here.
    template <class Vertex, class Cell>
    void each(const Vertex& vertex, const Cell& cell) const
    {
        line_cell c;
        for (std::size_t t = 0; t < layout_.texts.size(); ++t)
        {
            std::vector<const line_section*> sections;
            std::vector<item_range> ranges;
            for (const auto& s : layout_.sections)
                if (s.text == t) sections.push_back(&s), ranges.push_back(s.items);
            const auto& text = *layout_.texts[t];
            text.each(ranges,
                      [&](std::size_t k, std::int64_t number, std::string_view line)
                      {
                          const line_section& s = *sections[k];
                          const tokens words(line, text.comment());
                          if (s.what != content::cells) return vertex(s, number, words);
                          c.groups.clear();
                          c.labels = {};
                          s.cell(words, c);
                          cell(c);
                      });
        }
    }

    void read()
    {
        each([this](const line_section& s, std::int64_t number, const tokens& w) { take_vertex(s, number, w); },
             [this](const line_cell& c)
             {
                 if (c.dimension() < 3) return;
                 const auto n = static_cast<std::size_t>(io::impl::shape_of(c.kind).corners);
                 add_solid(c.kind, std::span<const std::int64_t>(c.corners).first(n));
             });
    }

    void take_vertex(const line_section& s, std::int64_t number, const tokens& w)
    {
        if (s.what == content::numbers || s.numbered) numbers_.push_back({w.integer(0), s.first + number});
        if (s.what == content::numbers) return;
        piece.ids.push_back(s.first + number);
        piece.points.emplace_back(w.real(s.word), w.real(s.word + 1), w.real(s.word + 2));
        if (s.group) s.group(w);
    }

    /// Collective. From the numbers of the file to places: by a difference, or by those who know.
    void find_numbers()
    {
        std::int64_t low = std::numeric_limits<std::int64_t>::max(), high = std::numeric_limits<std::int64_t>::min();
        for (const auto& [number, place] : numbers_)
            low = std::min(low, number - place), high = std::max(high, number - place);
        low = all_.least(low);
        high = all_.most(high);
        if (low > high) low = high = layout_.first_number; // none is written
        difference_ = low;
        if (low == high) return;
        std::vector<std::int64_t> ids;
        std::vector<vec3> places; // exact as doubles
        for (const auto& [number, place] : numbers_)
        {
            ids.push_back(number);
            places.emplace_back(static_cast<double>(place), 0, 0);
        }
        try
        {
            known_ = std::make_unique<homes>(all_, ids, places);
        }
        catch (const error&) // two of a number
        {
            throw unsuited("vertices have negative numbers, or the same one");
        }
        for (std::size_t k = 0; k < known_->known().size(); ++k)
            known_->number(k) = static_cast<std::int64_t>(known_->known()[k].x.x);
    }

    /// Collective. Throws unsuited for a number that no vertex has.
    std::vector<std::int64_t> places_of(std::vector<std::int64_t> numbers) const
    {
        if (known_)
            numbers = known_->find(numbers);
        else
            for (auto& n : numbers) n -= difference_;
        suited(all_,
               [&]
               {
                   for (const std::int64_t n : numbers)
                       if (n < 0 || n >= vertices) throw unsuited("a cell names a vertex that is not there");
               });
        return numbers;
    }

    /// Collective. The names of all processes, in one order; those that several groups have get the dimension behind.
    void share_names()
    {
        const auto& mine = layout_.groups->keys();
        std::vector<std::string> named;
        for (const auto& k : mine)
            named.push_back(std::string(k.spare ? "1" : "0") + std::to_string(k.dimension) + k.name);
        std::map<group_names::key, std::int64_t> known;
        for (const auto& told : all_.gathered(named))
            known.try_emplace({told.substr(2), told[1] - '0', told[0] == '1'});
        const bool spare = std::all_of(known.begin(), known.end(), [](const auto& k) { return k.first.spare; }) ||
                           std::none_of(known.begin(), known.end(), [](const auto& k) { return k.first.spare; });
        std::map<std::string, int> count;
        for (const auto& [k, n] : known) count[k.name] += spare || !k.spare;
        for (auto& [k, n] : known)
        {
            n = -1;
            if (k.spare && !spare) continue;
            n = static_cast<std::int64_t>(groups.size());
            groups.push_back({count[k.name] > 1 ? k.name + ':' + std::to_string(k.dimension) : k.name, k.dimension});
        }
        for (const auto& k : mine) group_of_.push_back(known.at(k));
    }

    /// The text of this process with other coordinates: those that have not changed, bit for bit, keep their bytes.
    std::string with(const std::vector<vec3>& x) const
    {
        std::vector<item_range> ranges;
        std::vector<const line_section*> sections;
        for (const auto& s : layout_.sections)
            if (s.what == content::vertices) sections.push_back(&s), ranges.push_back(s.items);
        const auto& text = *layout_.texts[0];
        std::size_t v = 0;
        return text.rewritten(
            ranges,
            [&](std::size_t k, std::int64_t, std::string_view line, std::string& out)
            {
                const tokens w(line, text.comment());
                std::size_t done = 0;
                for (int i = 0; i < 3; ++i)
                {
                    const std::size_t word = sections[k]->word + static_cast<std::size_t>(i);
                    const double now = x[v][i];
                    if (std::bit_cast<std::uint64_t>(now) == std::bit_cast<std::uint64_t>(piece.points[v][i])) continue;
                    const auto at = static_cast<std::size_t>(w.word(word).data() - line.data());
                    out.append(line, done, at - done);
                    std::array<char, 32> digits;
                    out.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), now).ptr);
                    done = at + w.word(word).size();
                }
                out.append(line, done);
                ++v;
            });
    }

    struct numbered
    {
        std::int64_t number, place;
    };

    line_layout layout_;
    std::vector<numbered> numbers_;      ///< while it is read
    std::int64_t difference_ = 0;        ///< of numbers and places
    std::unique_ptr<homes> known_;       ///< where there is none
    std::vector<std::int64_t> group_of_; ///< by the number among the names here
};

} // namespace taut::dist::impl
