// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <initializer_list>
#include <random>
#include <string>
#include <string_view>

namespace taut::fuzz
{

/// Random choices of who makes files.
class dice
{
public:
    explicit dice(unsigned seed) : random_(seed) {}

    std::size_t below(std::size_t n) { return random_() % n; }
    std::size_t between(std::size_t low, std::size_t high) { return low + below(high - low + 1); }
    bool one_in(std::size_t n) { return below(n) == 0; }

    std::string_view pick(std::initializer_list<std::string_view> words) { return words.begin()[below(words.size())]; }

    /// A number as files have them; seldom one that readers must refuse, or nearly.
    std::string number()
    {
        if (one_in(60))
            return std::string(
                pick({"nan", "-inf", "1e400", "1e-400", "1.9", "+2", "+-2", "00003", "4294967296", "2147483647",
                      "-2147483648", "9223372036854775807", "99999999999999999999", "0x1", "1e", ".", "-"}));
        if (one_in(60)) return '1' + std::string(between(1, 400), '0') + "e-" + std::to_string(between(1, 400));
        return std::to_string(static_cast<int>(below(9)) - 4) +
               std::string(pick({"", "", ".5", ".0", ".125", "e0", "e-3"}));
    }

    /// A whole number below n, seldom another one.
    std::string count(std::size_t n)
    {
        if (one_in(80)) return std::to_string(static_cast<int>(below(12)) - 3);
        return one_in(200) ? number() : std::to_string(below(n == 0 ? 1 : n));
    }

private:
    std::minstd_rand random_;
};

} // namespace taut::fuzz
