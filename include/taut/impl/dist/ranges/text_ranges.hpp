// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/dist/ranges/shared_file.hpp>
#include <taut/impl/dist/ranges/tokens.hpp>

namespace taut::dist::impl
{

/// What a line of a text is.
enum class line_kind : std::uint8_t
{
    nothing, ///< blank, or a comment
    heading, ///< begins a section
    item
};

/// A heading with the items that lie before it in the file.
struct heading
{
    std::int64_t at; ///< number of the first item behind it
    std::string text;
};

/// Items that follow each other.
struct item_range
{
    std::int64_t begin, count;
    std::int64_t end() const { return begin + count; }
};

/// A text of which each process has the lines that begin in its share of the bytes. Items, which are the lines between
/// headings, have numbers over the whole file; headings are known to all.
class text_ranges
{
public:
    /// Collective. kind(line): what it is. Throws unsuited.
    template <class Kind>
    text_ranges(const communicator& all, const std::filesystem::path& path, char comment, const Kind& kind)
        : all_(all), comment_(comment)
    {
        const shared_input file(all, path);
        suited(all, [&] { read(file); });
        std::vector<heading> mine;
        suited(all,
               [&]
               {
                   each_line(
                       [&](std::string_view line)
                       {
                           const line_kind k = kind(line);
                           kinds_.push_back(k);
                           if (k == line_kind::item) ++items_;
                           if (k != line_kind::heading) return;
                           mine.push_back({items_, std::string(line)});
                           if (mine.size() > most_headings) throw unsuited("it has very many sections");
                       });
               });
        first_ = all.before(items_);
        total_ = all.sum(items_);
        for (auto& h : mine) h.at += first_;
        share(mine);
    }

    const std::vector<heading>& headings() const { return headings_; }
    std::int64_t items() const { return total_; } ///< of all processes
    char comment() const { return comment_; }

    /// Collective. The text of items, known to all; they must be few.
    std::vector<std::string> lines(std::int64_t begin, std::int64_t count) const
    {
        if (begin < 0 || count < 0 || begin > total_ || count > total_ - begin) throw unsuited("it ends too early");
        if (count > most_lines) throw unsuited("it has very many entities");
        std::vector<std::string> mine;
        each(std::vector<item_range>{{begin, count}},
             [&](std::size_t, std::int64_t, std::string_view line) { mine.emplace_back(line); });
        return all_.gathered(mine);
    }

    /// Calls f(range, number, line) for the items here of ranges, which ascend; numbers count from the beginning of
    /// theirs.
    template <class F>
    void each(const std::vector<item_range>& ranges, const F& f) const
    {
        std::int64_t item = first_;
        std::size_t k = 0, at = 0;
        while (at < ranges.size() && ranges[at].end() <= first_) ++at;
        if (at == ranges.size() || ranges[at].begin >= first_ + items_) return;
        each_line(
            [&](std::string_view line)
            {
                if (kinds_[k++] != line_kind::item) return;
                while (at < ranges.size() && ranges[at].end() <= item) ++at;
                if (at < ranges.size() && item >= ranges[at].begin) f(at, item - ranges[at].begin, line);
                ++item;
            });
    }

    /// The text of this process with the items of ranges as f(range, number, line, out) appends them to `out`.
    template <class F>
    std::string rewritten(const std::vector<item_range>& ranges, const F& f) const
    {
        std::string out;
        out.reserve(text_.size() + text_.size() / 8);
        std::size_t done = 0;
        each(ranges,
             [&](std::size_t range, std::int64_t number, std::string_view line)
             {
                 const auto at = static_cast<std::size_t>(line.data() - text_.data());
                 out.append(text_, done, at - done);
                 f(range, number, line, out);
                 done = at + line.size();
             });
        out.append(text_, done);
        return out;
    }
    const std::string& text() const { return text_; } ///< of this process

private:
    static constexpr std::size_t most_headings = 100000, step = 1 << 16;
    static constexpr std::int64_t most_lines = 1000000;

    /// The lines that begin in this share of the bytes.
    void read(const shared_input& file)
    {
        const auto P = static_cast<std::size_t>(all_.size()), r = static_cast<std::size_t>(all_.rank());
        const std::size_t begin = file.size / P * r + file.size % P * r / P,
                          end = file.size / P * (r + 1) + file.size % P * (r + 1) / P;
        if (begin == end) return;
        const std::size_t before = begin > 0 ? 1 : 0;
        text_ = file.bytes(begin - before, end - begin + before);
        // The first line here begins behind the first line end from the byte before on.
        std::size_t first = 0;
        if (before != 0)
        {
            first = text_.find('\n');
            if (first == text_.npos || first + 1 == text_.size()) first = text_.size() - 1;
            ++first;
        }
        const bool none = first >= text_.size();
        while (!none && text_.back() != '\n')
        {
            const std::size_t at = begin - before + text_.size();
            if (at >= file.size) break;
            const std::string more = file.bytes(at, step);
            const auto line_end = more.find('\n');
            text_.append(more, 0, line_end == more.npos ? more.size() : line_end + 1);
            if (text_.size() - (end - begin) > 64 * step) throw unsuited("it has very long lines");
        }
        text_.erase(0, first);
        if (std::memchr(text_.data(), 0, text_.size()) != nullptr) throw unsuited("it is binary");
    }

    /// Line ends are no part of the lines.
    template <class F>
    void each_line(const F& f) const
    {
        const std::string_view all(text_);
        for (std::size_t at = 0; at < all.size();)
        {
            const std::size_t end = std::min(all.find('\n', at), all.size());
            std::string_view line = all.substr(at, end - at);
            if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
            f(line);
            at = end + 1;
        }
    }

    void share(const std::vector<heading>& mine)
    {
        std::vector<std::int64_t> at;
        std::vector<std::string> texts;
        for (const auto& h : mine)
        {
            at.push_back(h.at);
            texts.push_back(h.text);
        }
        at = all_.gathered(at);
        texts = all_.gathered(texts);
        for (std::size_t k = 0; k < at.size(); ++k) headings_.push_back({at[k], std::move(texts[k])});
    }

    communicator all_;
    char comment_;
    std::string text_;
    std::vector<line_kind> kinds_; ///< of the lines here
    std::int64_t items_ = 0, first_ = 0, total_ = 0;
    std::vector<heading> headings_;
};

} // namespace taut::dist::impl
