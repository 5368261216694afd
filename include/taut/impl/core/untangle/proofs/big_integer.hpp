// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace taut::impl
{

/// An integer of any size: a sign and digits.
class big_integer
{
public:
    big_integer() = default;

    /// x 2^power, which is an integer.
    static big_integer scaled(double x, int power)
    {
        big_integer result;
        if (x == 0) return result;
        int exponent = 0;
        auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
        result.negative_ = mantissa < 0;
        const auto size = static_cast<std::uint64_t>(result.negative_ ? -mantissa : mantissa);
        result.digits_ = {static_cast<std::uint32_t>(size), static_cast<std::uint32_t>(size >> 32U)};
        result.shift(exponent - 53 + power);
        return result;
    }

    /// The least power for which x 2^power is an integer; 0 of 0.
    static int least_power(double x)
    {
        if (x == 0) return 0;
        int exponent = 0;
        const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
        return 53 - exponent - std::countr_zero(static_cast<std::uint64_t>(mantissa));
    }

    int sign() const { return digits_.empty() ? 0 : negative_ ? -1 : 1; }

    /// x 2^-power, rounded down in its lowest digits.
    double rounded(int power) const
    {
        double result = 0;
        for (std::size_t k = digits_.size(); k-- > 0 && k + 4 > digits_.size();)
            result += std::ldexp(static_cast<double>(digits_[k]), static_cast<int>(32 * k) - power);
        return negative_ ? -result : result;
    }

    /// Number of bits of its magnitude: 2^(bits - 1) <= |x| < 2^bits.
    int bits() const
    {
        return digits_.empty() ? 0 : static_cast<int>(32 * digits_.size()) - std::countl_zero(digits_.back());
    }

    big_integer operator-() const
    {
        big_integer result = *this;
        result.negative_ = !negative_;
        return result;
    }

    friend big_integer operator+(const big_integer& a, const big_integer& b)
    {
        if (a.negative_ == b.negative_) return {a.negative_, sum(a.digits_, b.digits_)};
        return less(a.digits_, b.digits_) ? big_integer(b.negative_, difference(b.digits_, a.digits_))
                                          : big_integer(a.negative_, difference(a.digits_, b.digits_));
    }
    friend big_integer operator-(const big_integer& a, const big_integer& b) { return a + -b; }

    friend big_integer operator*(const big_integer& a, const big_integer& b)
    {
        if (a.sign() == 0 || b.sign() == 0) return {};
        digits product(a.digits_.size() + b.digits_.size(), 0);
        for (std::size_t i = 0; i < a.digits_.size(); ++i)
        {
            std::uint64_t carry = 0;
            for (std::size_t j = 0; j < b.digits_.size(); ++j)
            {
                carry += std::uint64_t{a.digits_[i]} * b.digits_[j] + product[i + j];
                product[i + j] = static_cast<std::uint32_t>(carry);
                carry >>= 32U;
            }
            product[i + b.digits_.size()] = static_cast<std::uint32_t>(carry);
        }
        return {a.negative_ != b.negative_, std::move(product)};
    }

    /// This divided by d, which is one of its divisors. From the lowest digit up: each follows from the lowest of d,
    /// made odd.
    big_integer quotient(big_integer d) const
    {
        big_integer rest = *this;
        const int twos = d.trailing_zeros();
        d.shift(-twos);
        rest.shift(-twos);
        if (rest.sign() == 0) return rest;
        std::uint32_t inverse = 1; // of the lowest digit, modulo 2^32: each step doubles the bits that are right
        for (int k = 0; k < 5; ++k) inverse *= 2 - d.digits_[0] * inverse;
        digits result(rest.digits_.size() - d.digits_.size() + 1, 0);
        for (std::size_t k = 0; k < result.size(); ++k)
        {
            result[k] = rest.digits_[k] * inverse;
            std::uint64_t borrow = 0;
            for (std::size_t j = 0; k + j < result.size(); ++j) // higher digits are not looked at
            {
                if (j < d.digits_.size()) borrow += std::uint64_t{result[k]} * d.digits_[j];
                const auto low = static_cast<std::uint32_t>(borrow);
                borrow = (borrow >> 32U) + (rest.digits_[k + j] < low ? 1 : 0);
                rest.digits_[k + j] -= low;
                if (borrow == 0 && j >= d.digits_.size()) break;
            }
        }
        return {negative_ != d.negative_, std::move(result)};
    }

private:
    using digits = std::vector<std::uint32_t>; // base 2^32, lowest first, the last one not 0

    big_integer(bool negative, digits d) : negative_(negative), digits_(std::move(d)) { trim(); }

    void trim()
    {
        while (!digits_.empty() && digits_.back() == 0) digits_.pop_back();
        negative_ = negative_ && !digits_.empty();
    }

    int trailing_zeros() const
    {
        std::size_t k = 0;
        while (digits_[k] == 0) ++k;
        return static_cast<int>(32 * k) + std::countr_zero(digits_[k]);
    }

    /// Times 2^power; bits that fall off are 0.
    void shift(int power)
    {
        const auto by = static_cast<std::size_t>(std::abs(power));
        const std::size_t whole = by / 32;
        const unsigned part = by % 32;
        if (power >= 0)
        {
            digits_.insert(digits_.begin(), whole, 0);
            std::uint32_t carry = 0;
            for (auto& d : digits_)
            {
                const std::uint64_t wide = (std::uint64_t{d} << part) | carry;
                d = static_cast<std::uint32_t>(wide);
                carry = static_cast<std::uint32_t>(wide >> 32U);
            }
            digits_.push_back(carry);
        }
        else
        {
            digits_.erase(digits_.begin(),
                          digits_.begin() + static_cast<std::ptrdiff_t>(std::min(whole, digits_.size())));
            for (std::size_t k = 0; k < digits_.size(); ++k)
            {
                const std::uint64_t wide =
                    digits_[k] | (k + 1 < digits_.size() ? std::uint64_t{digits_[k + 1]} << 32U : 0);
                digits_[k] = static_cast<std::uint32_t>(wide >> part);
            }
        }
        trim();
    }

    static bool less(const digits& a, const digits& b)
    {
        if (a.size() != b.size()) return a.size() < b.size();
        return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
    }

    static digits sum(const digits& a, const digits& b)
    {
        digits result(std::max(a.size(), b.size()) + 1, 0);
        std::uint64_t carry = 0;
        for (std::size_t k = 0; k < result.size(); ++k)
        {
            carry += (k < a.size() ? std::uint64_t{a[k]} : 0) + (k < b.size() ? b[k] : 0);
            result[k] = static_cast<std::uint32_t>(carry);
            carry >>= 32U;
        }
        return result;
    }

    /// a - b of a >= b.
    static digits difference(digits a, const digits& b)
    {
        std::uint32_t borrow = 0;
        for (std::size_t k = 0; k < a.size() && (k < b.size() || borrow != 0); ++k)
        {
            const std::uint64_t taken = std::uint64_t{k < b.size() ? b[k] : 0} + borrow;
            borrow = a[k] < taken ? 1 : 0;
            a[k] -= static_cast<std::uint32_t>(taken);
        }
        return a;
    }

    bool negative_ = false;
    digits digits_;
};

} // namespace taut::impl
