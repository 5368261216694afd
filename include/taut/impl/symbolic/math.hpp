// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>

#include <taut/impl/symbolic/arithmetic.hpp>
#include <taut/impl/symbolic/power.hpp>

namespace taut::impl
{

/// The functions of <cmath> and <algorithm> on traced values, found by their argument: write sqrt(x), not std::sqrt(x).
/// Generic code adds `using std::sqrt;` and then serves both double and sym<double>.
template <class T>
struct sym_math
{
    /// As std::min and std::max in the case of NaN, too: the first argument unless the second is strictly beyond it.
    friend sym<T> min(sym<T> a, sym<T> b) { return select(b < a, b, a); }
    friend sym<T> max(sym<T> a, sym<T> b) { return select(a < b, b, a); }

    friend sym<T> abs(sym<T> x)
    {
        if constexpr (std::integral<T>)
            return select(x < 0, -x, x); // the device's abs() of an int is unsigned
        else
            return function(opcode::abs, x);
    }
    friend sym<T> fabs(sym<T> x) requires std::floating_point<T> { return function(opcode::abs, x); }
    friend sym<T> floor(sym<T> x) requires std::floating_point<T> { return function(opcode::floor, x); }
    friend sym<T> sqrt(sym<T> x) requires std::floating_point<T> { return function(opcode::sqrt, x); }
    friend sym<T> cbrt(sym<T> x) requires std::floating_point<T> { return function(opcode::cbrt, x); }
    friend sym<T> exp(sym<T> x) requires std::floating_point<T> { return function(opcode::exp, x); }
    friend sym<T> log(sym<T> x) requires std::floating_point<T> { return function(opcode::log, x); }
    friend sym<T> sin(sym<T> x) requires std::floating_point<T> { return function(opcode::sin, x); }
    friend sym<T> cos(sym<T> x) requires std::floating_point<T> { return function(opcode::cos, x); }
    friend sym<T> tan(sym<T> x) requires std::floating_point<T> { return function(opcode::tan, x); }
    friend sym<T> atan(sym<T> x) requires std::floating_point<T> { return function(opcode::atan, x); }

    /// Constant integer and half-integer exponents become products and square roots.
    friend sym<T> pow(sym<T> x, sym<T> exponent) requires std::floating_point<T>
    {
        tape& t = tape::current();
        node_id base = x.id(), power = exponent.id();
        shared_type(t, base, power);
        return sym<T>::of(build_power(t, base, power));
    }

private:
    static sym<T> function(opcode op, sym<T> x)
    {
        tape& t = tape::current();
        return sym<T>::of(build(t, op, t[x.id()].type, x.id()));
    }
};

} // namespace taut::impl
