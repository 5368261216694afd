// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>

#include <taut/impl/dist/ranges/unsuited.hpp>

namespace taut::dist::impl
{

/// The words of a line up to a comment.
class tokens
{
public:
    /// comment: what begins one; 0: nothing does.
    explicit tokens(std::string_view line, char comment = '\0')
    {
        for (std::size_t at = 0; at < line.size() && count_ < words_.size();)
        {
            while (at < line.size() && blank(line[at])) ++at;
            const std::size_t begin = at;
            while (at < line.size() && !blank(line[at]) && line[at] != comment) ++at;
            if (at > begin) words_[count_++] = line.substr(begin, at - begin);
            if (at < line.size() && line[at] == comment && comment != '\0') break;
        }
    }

    static bool blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

    std::size_t size() const { return count_; }

    std::string_view word(std::size_t k) const
    {
        if (k >= count_) throw unsuited("a line is shorter than its items");
        return words_[k];
    }

    std::int64_t integer(std::size_t k) const
    {
        const std::string_view w = word(k);
        const std::size_t plus = w.front() == '+' ? 1 : 0;
        std::int64_t x = 0;
        const auto [end, failure] = std::from_chars(w.data() + plus, w.data() + w.size(), x);
        if (failure != std::errc{} || end != w.data() + w.size()) throw unsuited("a word is no integer");
        return x;
    }

    /// A number, whose exponent may begin with D.
    double real(std::size_t k) const
    {
        std::string_view w = word(k);
        if (w.front() == '+') w.remove_prefix(1);
        double x = 0;
        auto [end, failure] = std::from_chars(w.data(), w.data() + w.size(), x);
        if (const auto d = w.find_first_of("dD"); failure == std::errc{} && d != w.npos && end == w.data() + d)
        {
            std::string e(w);
            e[d] = 'e';
            const auto again = std::from_chars(e.data(), e.data() + e.size(), x);
            failure = again.ptr == e.data() + e.size() ? again.ec : std::errc::invalid_argument;
            end = w.data() + w.size();
        }
        if (failure != std::errc{} || end != w.data() + w.size() || !std::isfinite(x))
            throw unsuited("a word is no finite number");
        return x;
    }

private:
    std::array<std::string_view, 24> words_;
    std::size_t count_ = 0;
};

} // namespace taut::dist::impl
