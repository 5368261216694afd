// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <taut/impl/dist/processes/communicator.hpp>

namespace taut::dist::impl
{

/// Sum of doubles in fixed point: every bit of each term is kept, so that the result is the same bits in whatever
/// order, and over whatever processes, terms are added (Neal 2015, "Fast exact summation using small and large
/// superaccumulators"). A term that is not finite makes the sum infinite. Fewer than 2^31 terms in all.
class fixed_sum
{
public:
    static constexpr std::size_t digits = 68; ///< base 2^32, the lowest of weight 2^-1074
    using limbs = std::array<std::int64_t, digits + 1>;

    void add(double x)
    {
        const auto bits = std::bit_cast<std::uint64_t>(x);
        const auto exponent = static_cast<std::uint32_t>(bits >> 52U & 0x7ffU);
        std::uint64_t mantissa = bits & 0xfffffffffffffU;
        if (exponent == 0x7ff)
        {
            ++limbs_[digits];
            return;
        }
        if (exponent != 0) mantissa |= std::uint64_t{1} << 52U;
        const std::uint32_t offset = exponent == 0 ? 0 : exponent - 1, shift = offset % 32;
        const std::uint64_t low = mantissa << shift;
        const auto first = static_cast<std::int64_t>(low & 0xffffffffU), second = static_cast<std::int64_t>(low >> 32U),
                   third = shift == 0 ? 0 : static_cast<std::int64_t>(mantissa >> (64 - shift));
        auto* const at = limbs_.data() + offset / 32;
        if (bits >> 63U)
            at[0] -= first, at[1] -= second, at[2] -= third;
        else
            at[0] += first, at[1] += second, at[2] += third;
    }

    const limbs& raw() const { return limbs_; }

    /// The value of limbs that may have been added up, to a few units of the last digit, always the same for the same
    /// sum.
    static double value(limbs n)
    {
        if (n[digits] != 0) return std::numeric_limits<double>::infinity();
        const auto carry = [&]
        {
            for (std::size_t k = 0; k + 1 < digits; ++k)
            {
                n[k + 1] += n[k] >> 32;
                n[k] &= 0xffffffff;
            }
        };
        carry();
        double sign = 1;
        if (n[digits - 1] < 0)
        {
            for (auto& limb : n) limb = -limb;
            carry();
            sign = -1;
        }
        double sum = 0;
        for (std::size_t k = digits; k-- > 0;)
            if (n[k] != 0) sum += std::ldexp(static_cast<double>(n[k]), static_cast<int>(32 * k) - 1074);
        return sign * sum;
    }

private:
    limbs limbs_{};
};

/// Sums over all processes, in one reduction, with word of whether one of them has failed on the way.
class shared_sums
{
public:
    explicit shared_sums(std::size_t n) : parts_(n) {}

    fixed_sum& operator[](std::size_t k) { return parts_[k]; }

    /// Collective. failure: of this process, or null; where any has one, all throw, as communicator::agree() does.
    std::vector<double> totals(const communicator& all, const std::exception_ptr& failure = nullptr) const
    {
        std::vector<std::int64_t> numbers;
        numbers.reserve(parts_.size() * std::tuple_size_v<fixed_sum::limbs> + 1);
        for (const auto& part : parts_) numbers.insert(numbers.end(), part.raw().begin(), part.raw().end());
        numbers.push_back(failure ? 1 : 0);
        all.add(std::span(numbers));
        if (numbers.back() != 0) all.fail(failure);
        std::vector<double> values;
        for (std::size_t k = 0; k < parts_.size(); ++k)
        {
            fixed_sum::limbs one{};
            std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(k * one.size()), one.size(), one.begin());
            values.push_back(fixed_sum::value(one));
        }
        return values;
    }

private:
    std::vector<fixed_sum> parts_;
};

} // namespace taut::dist::impl
