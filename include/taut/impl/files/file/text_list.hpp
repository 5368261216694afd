// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace taut::io::impl
{

/// Short texts, kept one after the other.
class text_list
{
public:
    std::size_t size() const { return ends_.size(); }

    std::string_view operator[](std::size_t i) const
    {
        const std::size_t begin = i == 0 ? 0 : ends_[i - 1];
        return std::string_view(all_).substr(begin, ends_[i] - begin);
    }

    /// Adds to the text that the next call of end() completes.
    void append(std::string_view part) { all_ += part; }
    void end() { ends_.push_back(all_.size()); }

    void add(std::string_view text)
    {
        append(text);
        end();
    }

private:
    std::string all_;
    std::vector<std::size_t> ends_;
};

/// Appends a number as it is written, with an exponent that every program reads.
inline void append_written(text_list& to, std::string_view number)
{
    const auto letter = number.find_first_of("dD");
    to.append(number.substr(0, letter));
    if (letter == number.npos) return;
    to.append("e");
    to.append(number.substr(letter + 1));
}

} // namespace taut::io::impl
