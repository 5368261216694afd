// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include <taut/impl/symbolic/sym.hpp>

/// GLM asks here whether a type is a floating-point number. The traits are those of T, the values are constants of the
/// current tape.
template <class T>
class std::numeric_limits<taut::sym<T>> : public std::numeric_limits<T>
{
    using host = std::numeric_limits<T>;

public:
    static taut::sym<T> min() { return host::min(); }
    static taut::sym<T> max() { return host::max(); }
    static taut::sym<T> lowest() { return host::lowest(); }
    static taut::sym<T> epsilon() { return host::epsilon(); }
    static taut::sym<T> round_error() { return host::round_error(); }
    static taut::sym<T> infinity() { return host::infinity(); }
    static taut::sym<T> quiet_NaN() { return host::quiet_NaN(); }
    static taut::sym<T> signaling_NaN() { return host::signaling_NaN(); }
    static taut::sym<T> denorm_min() { return host::denorm_min(); }
};
