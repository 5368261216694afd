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

/// What a fuzzer tries next: a new file by generate(dice), the old one with a line changed, or with other bytes.
template <class Generate>
std::size_t mutate(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed, Generate generate)
{
    dice random(seed);
    const std::size_t how = random.below(8);
    if (how > 3) return LLVMFuzzerMutate(data, size, most);
    const std::string text =
        how == 0 ? generate(random) : change_line(std::string(reinterpret_cast<const char*>(data), size), random);
    const std::size_t used = std::min(most, text.size());
    std::copy_n(text.data(), used, data);
    return used;
}

} // namespace taut::fuzz
