// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace taut::impl
{

/// Exact sum of signed products of `Factors` doubles, by a long fixed-point accumulator (Kulisch).
///
/// Every finite double is m * 2^e with an integer |m| < 2^53 and -1074 <= e <= 971, so a product is an integer times
/// 2^(-1074 Factors) and a sum of products is one long integer. Only integer arithmetic decides the sign: no compiler
/// flag (contraction, excess precision, fast-math) and no underflow can spoil it, unlike floating-point expansions.
template <int Factors>
class exact_sum
{
public:
    /// Adds (negative ? -1 : 1) * product of the factors. Factors are finite; fewer than 2^30 additions.
    void add(bool negative, const std::array<double, Factors>& factors)
    {
        digits product{1};
        std::size_t offset = 0; // bits, counted from the lowest that a product can have
        for (const double factor : factors)
        {
            const auto bits = std::bit_cast<std::uint64_t>(factor);
            const std::uint64_t exponent = bits >> 52U & 0x7ffU;
            std::uint64_t mantissa = bits & 0xfffffffffffffU;
            if (exponent != 0) mantissa |= std::uint64_t{1} << 52U; // a normal number hides its leading one
            if (mantissa == 0) return;
            negative ^= bits >> 63U != 0;
            offset += exponent == 0 ? 0U : exponent - 1U;
            multiply(product, mantissa);
        }
        const std::size_t first = offset / 32;
        const std::size_t shift = offset % 32;
        for (std::size_t k = 0; k < product.size(); ++k)
        {
            const std::uint64_t part = std::uint64_t{product[k]} << shift;
            const auto low = static_cast<std::int64_t>(part & 0xffffffffU);
            const auto high = static_cast<std::int64_t>(part >> 32U);
            limbs_[first + k] += negative ? -low : low;
            limbs_[first + k + 1] += negative ? -high : high;
        }
    }

    /// Sign of the sum: -1, 0 or 1. Leaves the magnitude behind for magnitude().
    int sign()
    {
        if (const std::int64_t carry = carry_over(); carry < 0)
        {
            for (auto& limb : limbs_) limb = -limb;
            carry_over();
            return -1;
        }
        for (const auto limb : limbs_)
            if (limb != 0) return 1;
        return 0;
    }

    /// |sum| to a few ulps; may round to 0 or to infinity. Call after sign().
    double magnitude() const
    {
        double total = 0;
        for (std::size_t k = limbs_.size(); k-- > 0;)
            if (limbs_[k] != 0)
                total += std::ldexp(static_cast<double>(limbs_[k]), static_cast<int>(32 * k) - 1074 * Factors);
        return total;
    }

private:
    using digits = std::array<std::uint32_t, 2 * Factors>; // base 2^32, lowest first

    static void multiply(digits& product, std::uint64_t mantissa)
    {
        const std::array<std::uint64_t, 2> digit{mantissa & 0xffffffffU, mantissa >> 32U};
        digits result{};
        for (std::size_t j = 0; j < 2; ++j)
        {
            std::uint64_t carry = 0;
            for (std::size_t i = 0; i + j < result.size(); ++i)
            {
                const std::uint64_t t = product[i] * digit[j] + result[i + j] + carry;
                result[i + j] = static_cast<std::uint32_t>(t);
                carry = t >> 32U;
            }
        }
        product = result;
    }

    /// Brings every limb into [0, 2^32) and returns what is left over the top: -1 for a negative sum, else 0.
    std::int64_t carry_over()
    {
        std::int64_t carry = 0;
        for (auto& limb : limbs_)
        {
            const std::int64_t total = limb + carry;
            limb = total & 0xffffffff;
            carry = total >> 32; // arithmetic shift: floor division
        }
        return carry;
    }

    std::array<std::int64_t, 2098 * Factors / 32 + 3> limbs_{};
};

} // namespace taut::impl
