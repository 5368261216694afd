// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dice.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace taut::fuzz
{

/// Repeats, leaves out, swaps or breaks a line, or replaces a word by a number.
inline std::string change_line(const std::string& text, dice& random)
{
    std::vector<std::string> lines(1);
    for (const char c : text)
    {
        lines.back() += c;
        if (c == '\n') lines.emplace_back();
    }
    std::string& line = lines[random.below(lines.size())];
    switch (random.below(5))
    {
    case 0:
        line += line;
        break;
    case 1:
        line.clear();
        break;
    case 2:
        std::swap(line, lines[random.below(lines.size())]);
        break;
    case 3:
        line.insert(random.below(line.size() + 1), random.pick({"\\\n", "\\\r\n", " # ", "#", "\r", " "}));
        break;
    default:
        const auto begin = line.find(' ', random.below(line.size() + 1));
        if (begin == line.npos) break;
        const auto end = std::min(line.find_first_of(" /\r\n", begin + 1), line.size());
        line.replace(begin + 1, end - begin - 1, random.number());
    }
    std::string result;
    for (const auto& l : lines) result += l;
    return result;
}

/// Repeats some lines until the text has `most` bytes: what is counted may be multiplied by another count.
inline std::string repeat_lines(const std::string& text, std::size_t most, dice& random)
{
    const auto line_at = [&](std::size_t at)
    {
        const auto end = text.rfind('\n', at);
        return end == text.npos ? 0 : end + 1;
    };
    const std::size_t a = line_at(random.below(text.size() + 1)), b = line_at(random.below(text.size() + 1));
    const std::size_t begin = std::min(a, b), end = std::max(a, b);
    const std::string lines = text.substr(begin, end - begin);
    std::string result = text.substr(0, end);
    while (!lines.empty() && result.size() + lines.size() + text.size() - end < most) result += lines;
    return result + text.substr(end);
}

/// What a fuzzer tries next: a new file by generate(dice), the old one with a line changed or, seldom, with lines
/// repeated up to 256 kB, or with other bytes.
template <class Generate>
std::size_t mutate(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed, Generate generate)
{
    dice random(seed);
    constexpr std::size_t seldom = 512, longest = 1 << 18, usual = 4096;
    const bool long_one = random.one_in(seldom);
    const std::size_t how = long_one ? 0 : random.below(8);
    most = std::min(most, long_one ? longest : usual); // long ones take long: none is made of another one
    size = std::min(size, most);
    if (how > 3) return LLVMFuzzerMutate(data, size, most);
    const std::string old(reinterpret_cast<const char*>(data), size);
    const std::string text = long_one   ? repeat_lines(random.one_in(2) ? generate(random) : old, most, random)
                             : how == 0 ? generate(random)
                                        : change_line(old, random);
    const std::size_t used = std::min(most, text.size());
    std::copy_n(text.data(), used, data);
    return used;
}

} // namespace taut::fuzz
