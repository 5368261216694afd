// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/dist/ranges/line_layout.hpp>

namespace taut::dist::impl
{

/// gmsh's text files of versions 2.2 and 4.1 by lines.
class gmsh_lines_reader
{
public:
    /// Collective. Throws unsuited.
    gmsh_lines_reader(const communicator& all, const std::filesystem::path& path)
    {
        layout_.texts.push_back(std::make_unique<text_ranges>(
            all, path, '\0',
            [](std::string_view line)
            {
                const auto kind = blank_or(line, '\0', line_kind::item);
                return kind == line_kind::item && tokens(line).word(0).front() == '$' ? line_kind::heading : kind;
            }));
        const auto& headings = text().headings();
        for (std::size_t k = 0; k + 1 < headings.size(); k += 2)
        {
            const std::string name(tokens(headings[k].text).word(0).substr(1));
            if (tokens(headings[k + 1].text).word(0).substr(1) != "End" + name) throw unsuited("a section has no end");
            sections_[name] = {headings[k].at, headings[k + 1].at - headings[k].at};
        }
        if (sections_.count("PartitionedEntities") + sections_.count("ParametricNodes") > 0)
            throw unsuited("it is in partitions, or its nodes are parametric");
        const auto format = words(section("MeshFormat").begin);
        if (format.integer(1) != 0) throw unsuited("it is binary");
        const double version = format.real(0);
        read_names();
        if (version == 4.1)
            read_4();
        else if (version >= 2 && version < 3)
            read_2();
        else
            throw unsuited("its version is not 2 or 4.1");
    }

    line_layout take() { return std::move(layout_); }

private:
    const text_ranges& text() const { return *layout_.texts[0]; }

    item_range section(const std::string& name) const
    {
        const auto found = sections_.find(name);
        if (found == sections_.end()) throw unsuited("it has no $" + name);
        return found->second;
    }

    tokens words(std::int64_t place)
    {
        line_ = text().lines(place, 1).at(0);
        return tokens(line_);
    }

    void read_names()
    {
        if (sections_.count("PhysicalNames") == 0) return;
        const auto range = section("PhysicalNames");
        const auto lines = text().lines(range.begin, range.count);
        for (std::size_t k = 1; k < lines.size(); ++k)
        {
            const tokens w(lines[k]);
            const auto first = lines[k].find('"'), last = lines[k].rfind('"');
            if (first == std::string::npos || last <= first) throw unsuited("a name has no quotes");
            if (last > first + 1) names_[{w.integer(0), w.integer(1)}] = lines[k].substr(first + 1, last - first - 1);
        }
    }

    static io::cell_kind kind_of(std::int64_t type)
    {
        switch (type)
        {
        case 15:
            return io::cell_kind::vertex;
        case 1:
            return io::cell_kind::line;
        case 2:
            return io::cell_kind::triangle;
        case 3:
            return io::cell_kind::quad;
        case 4:
            return io::cell_kind::tetrahedron;
        case 5:
            return io::cell_kind::hexahedron;
        case 6:
            return io::cell_kind::wedge;
        case 7:
            return io::cell_kind::pyramid;
        default:
            throw unsuited("it has cells of a kind that is not read by ranges");
        }
    }

    int physical(int dimension, std::int64_t tag) const
    {
        const auto named = names_.find({dimension, tag});
        if (named != names_.end()) return layout_.groups->number({named->second, dimension, false});
        return layout_.groups->tagged("physical:" + std::to_string(dimension), tag, dimension);
    }

    void read_2()
    {
        const auto nodes = section("Nodes"), elements = section("Elements");
        const std::int64_t n = words(nodes.begin).integer(0), m = words(elements.begin).integer(0);
        if (n != nodes.count - 1 || m != elements.count - 1) throw unsuited("it has not one item a line");
        layout_.vertices = n;
        layout_.sections.push_back({.what = line_section::content::vertices,
                                    .text = 0,
                                    .items = {nodes.begin + 1, n},
                                    .word = 1,
                                    .numbered = true});
        layout_.sections.push_back(
            {.what = line_section::content::cells,
             .text = 0,
             .items = {elements.begin + 1, m},
             .cell = [names = names_, groups = layout_.groups.get()](const tokens& w, line_cell& c)
             {
                 c.kind = kind_of(w.integer(1));
                 const std::int64_t tags = w.integer(2);
                 if (tags < 0 || tags > 3) throw unsuited("it is in partitions");
                 const std::int64_t physical = tags > 0 ? w.integer(3) : 0, entity = tags > 1 ? w.integer(4) : 0;
                 c.take(w, static_cast<std::size_t>(3 + tags), wedge_order::turned);
                 const int d = c.dimension();
                 c.labels = {physical, entity};
                 const auto named = physical != 0 ? names.find({d, physical}) : names.end();
                 if (named != names.end())
                     c.groups.push_back(groups->number({named->second, d, false}));
                 else if (physical != 0)
                     c.groups.push_back(groups->tagged("physical:" + std::to_string(d), physical, d));
                 if (entity != 0) c.groups.push_back(groups->tagged("entity:" + std::to_string(d), entity, d, true));
             }});
        sort();
    }

    void read_4()
    {
        if (sections_.count("Entities") != 0) read_entities();
        auto at = section("Nodes").begin;
        const std::int64_t end = section("Nodes").end();
        for (std::int64_t blocks = words(at++).integer(0); blocks > 0; --blocks)
        {
            const auto head = words(at++);
            const std::int64_t n = head.integer(3);
            if (head.integer(2) != 0) throw unsuited("its nodes are parametric");
            if (n < 0 || n > (end - at) / 2) throw unsuited("a section is too short");
            if (n == 0) continue;
            layout_.sections.push_back(
                {.what = line_section::content::numbers, .text = 0, .items = {at, n}, .first = layout_.vertices});
            layout_.sections.push_back(
                {.what = line_section::content::vertices, .text = 0, .items = {at + n, n}, .first = layout_.vertices});
            layout_.vertices += n;
            at += 2 * n;
        }
        if (at != end) throw unsuited("a section does not end where its counts say");
        read_elements_4();
        sort();
    }

    void read_elements_4()
    {
        auto at = section("Elements").begin;
        const std::int64_t end = section("Elements").end();
        for (std::int64_t blocks = words(at++).integer(0); blocks > 0; --blocks)
        {
            const auto head = words(at++);
            const int dimension = static_cast<int>(head.integer(0));
            const std::int64_t tag = head.integer(1), n = head.integer(3);
            const auto kind = kind_of(head.integer(2));
            if (n < 0 || n > end - at) throw unsuited("a section is too short");
            std::vector<int> groups;
            const auto& tags = physical_[{dimension, tag}];
            for (const std::int64_t p : tags) groups.push_back(physical(dimension, p));
            if (n > 0)
                groups.push_back(layout_.groups->tagged("entity:" + std::to_string(dimension), tag, dimension, true));
            layout_.sections.push_back(
                {.what = line_section::content::cells,
                 .text = 0,
                 .items = {at, n},
                 .cell = [kind, groups, physical = tags.empty() ? 0 : tags.front(), tag](const tokens& w, line_cell& c)
                 {
                     c.kind = kind;
                     c.take(w, 1, wedge_order::turned);
                     c.groups = groups;
                     c.labels = {physical, tag};
                 }});
            at += n;
        }
        if (at != end) throw unsuited("a section does not end where its counts say");
    }

    void read_entities()
    {
        const auto range = section("Entities");
        const auto lines = text().lines(range.begin, range.count);
        const auto w = numbers(item(lines, 0));
        std::size_t line = 1;
        for (int d = 0; d <= 3; ++d)
            for (std::size_t k = 0; static_cast<double>(k) < item(w, static_cast<std::size_t>(d)); ++k)
            {
                const auto entity = numbers(item(lines, line++));
                const std::size_t count = d == 0 ? 4 : 7;
                auto& groups = physical_[{d, static_cast<std::int64_t>(item(entity, 0))}];
                for (std::size_t p = 0; p < static_cast<std::size_t>(item(entity, count)); ++p)
                    groups.push_back(std::abs(static_cast<std::int64_t>(item(entity, count + 1 + p))));
            }
    }

    /// All the numbers of a line, however many.
    static std::vector<double> numbers(const std::string& line)
    {
        std::vector<double> result;
        for (std::size_t at = 0; (at = line.find_first_not_of(" \t\r", at)) != line.npos;)
        {
            const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
            result.push_back(tokens(std::string_view(line).substr(at, end - at)).real(0));
            at = end;
        }
        return result;
    }

    template <class T>
    static const T& item(const std::vector<T>& all, std::size_t k)
    {
        if (k >= all.size()) throw unsuited("a section is too short");
        return all[k];
    }

    void sort()
    {
        std::sort(layout_.sections.begin(), layout_.sections.end(),
                  [](const auto& a, const auto& b) { return a.items.begin < b.items.begin; });
    }

    line_layout layout_;
    std::string line_;
    std::map<std::string, item_range> sections_;
    std::map<std::pair<std::int64_t, std::int64_t>, std::string> names_;
    std::map<std::pair<int, std::int64_t>, std::vector<std::int64_t>> physical_;
};

} // namespace taut::dist::impl
