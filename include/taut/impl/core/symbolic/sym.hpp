// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <taut/impl/core/symbolic/evaluate.hpp>
#include <taut/impl/core/symbolic/power.hpp>
#include <taut/impl/core/symbolic/reverse.hpp>
#include <taut/symbolic.hpp>

namespace taut::impl
{

/// The operators of sym<T>, for sym<T> to inherit.
///
/// They are friends and no templates, which only an argument of type sym<T> brings into view: so literals and
/// proxies of array elements convert to sym<T>, and code that does not mention sym<T> never sees them. Two different
/// precisions do not mix: float + double is an error where it is written, not a slow kernel.
///
/// sym<double> may be in float all the same, where a recording chose so for its arrays (recording::in): precision is
/// then data, and an error of the recording where it is mixed.
template <class T>
struct sym_arithmetic
{
    friend sym<T> operator+(sym<T> a) { return a; }
    friend sym<T> operator-(sym<T> a) { return make(opcode::neg, a); }
    friend sym<T> operator+(sym<T> a, sym<T> b) { return make(opcode::add, a, b); }
    friend sym<T> operator-(sym<T> a, sym<T> b) { return make(opcode::sub, a, b); }
    friend sym<T> operator*(sym<T> a, sym<T> b) { return make(opcode::mul, a, b); }
    friend sym<T> operator/(sym<T> a, sym<T> b) { return make(opcode::div, a, b); }
    friend sym<T> operator%(sym<T> a, sym<T> b) requires std::integral<T> { return make(opcode::rem, a, b); }

    // The handle moves on to a new node; other copies of the old handle keep their value.
    friend sym<T>& operator+=(sym<T>& a, sym<T> b) { return a = a + b; }
    friend sym<T>& operator-=(sym<T>& a, sym<T> b) { return a = a - b; }
    friend sym<T>& operator*=(sym<T>& a, sym<T> b) { return a = a * b; }
    friend sym<T>& operator/=(sym<T>& a, sym<T> b) { return a = a / b; }

    // > and >= have no node of their own: a > b is b < a, also for NaN.
    friend sym_bool operator<(sym<T> a, sym<T> b) { return compare(opcode::less, a, b); }
    friend sym_bool operator>(sym<T> a, sym<T> b) { return compare(opcode::less, b, a); }
    friend sym_bool operator<=(sym<T> a, sym<T> b) { return compare(opcode::less_equal, a, b); }
    friend sym_bool operator>=(sym<T> a, sym<T> b) { return compare(opcode::less_equal, b, a); }
    friend sym_bool operator==(sym<T> a, sym<T> b) { return compare(opcode::equal, a, b); }
    friend sym_bool operator!=(sym<T> a, sym<T> b) { return compare(opcode::not_equal, a, b); }

    /// cond ? a : b, without a branch: both are computed, one is taken, and only the taken one has a derivative.
    friend sym<T> select(sym_bool cond, sym<T> a, sym<T> b)
    {
        tape& t = tape::current();
        node_id yes = a.id(), no = b.id();
        const scalar_type type = shared_type(t, yes, no);
        return sym<T>::of(build(t, opcode::select, type, cond.id(), yes, no));
    }

protected:
    static sym<T> make(opcode op, sym<T> a)
    {
        tape& t = tape::current();
        return sym<T>::of(build(t, op, t[a.id()].type, a.id()));
    }

    static sym<T> make(opcode op, sym<T> a, sym<T> b)
    {
        tape& t = tape::current();
        node_id left = a.id(), right = b.id();
        const scalar_type type = shared_type(t, left, right);
        return sym<T>::of(build(t, op, type, left, right));
    }

private:
    static sym_bool compare(opcode op, sym<T> a, sym<T> b)
    {
        tape& t = tape::current();
        node_id left = a.id(), right = b.id();
        shared_type(t, left, right);
        return sym_bool::of(build(t, op, scalar_type::boolean, left, right));
    }
};

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

/// The host scalar behind a traced one; a host scalar is its own.
template <class T>
struct value_type
{
    using type = T;
};

template <class T>
struct value_type<sym<T>>
{
    using type = T;
};

template <class T>
using value_type_t = typename value_type<T>::type;

} // namespace taut::impl

namespace taut
{

static_assert(std::is_trivially_copyable_v<sym<double>> && std::is_trivially_default_constructible_v<sym<double>>);
static_assert(sizeof(sym<double>) == sizeof(impl::node_id));

template <std::floating_point T>
sym<T> select(sym_bool cond, T a, T b)
{
    return select(cond, sym<T>(a), sym<T>(b));
}

template <impl::traceable To, impl::traceable From>
sym<To> cast(sym<From> x)
{
    return sym<To>::of(impl::build(tape::current(), impl::opcode::cast, impl::scalar_type_of<To>, x.id()));
}

inline sym<double> cast(scalar_type to, sym<double> x)
{
    return sym<double>::of(impl::build(tape::current(), impl::opcode::cast, to, x.id()));
}

template <class F>
auto sum_over(sym<idx> begin, sym<idx> end, F&& summand)
{
    tape& t = tape::current();
    using result = decltype(+std::forward<F>(summand)(sym<idx>())); // a proxy becomes its value

    struct open_loop // closes also when the summand throws
    {
        explicit open_loop(tape& on) : t(on), index_node(on.open_loop()) {}
        ~open_loop() { t.close_loop(); }
        open_loop(const open_loop&) = delete;
        open_loop& operator=(const open_loop&) = delete;
        tape& t;
        impl::node_id index_node;
    };

    const impl::node_id first = begin.id();
    const impl::node_id last = end.id();
    impl::node_id term = impl::no_node;
    impl::node_id loop = impl::no_node;
    {
        const open_loop body(t);
        loop = body.index_node;
        const result r = std::forward<F>(summand)(sym<idx>::of(loop));
        term = r.id();
    }
    return result::of(t.intern({.op = impl::opcode::loop_sum,
                                .type = t[term].type,
                                .operands = {first, last, term},
                                .payload = static_cast<std::uint64_t>(loop)}));
}

template <class T, class X>
std::vector<sym<X>> differentiate(sym<T> f, std::span<const sym<X>> x)
{
    std::vector<impl::node_id> ids;
    ids.reserve(x.size());
    for (const sym<X> variable : x) ids.push_back(variable.id());

    std::vector<sym<X>> partials;
    partials.reserve(x.size());
    for (const impl::node_id partial : impl::reverse_sweep(tape::current(), f.id(), ids))
        partials.push_back(partial == impl::no_node ? sym<X>(X(0)) : sym<X>::of(partial));
    return partials;
}

template <impl::traceable T>
T evaluate(sym<T> f, std::initializer_list<binding> bindings)
{
    return evaluate(std::vector<sym<T>>{f}, std::span(bindings.begin(), bindings.size())).front();
}

template <impl::traceable T>
std::vector<T> evaluate(const std::vector<sym<T>>& outputs, std::span<const binding> bindings)
{
    std::vector<impl::node_id> roots;
    for (const sym<T> output : outputs) roots.push_back(output.id());
    std::vector<T> values;
    for (const std::uint64_t bits : impl::evaluated(tape::current(), roots, bindings))
        values.push_back(impl::from_bits<T>(bits));
    return values;
}

inline bool evaluate(sym_bool f, std::initializer_list<binding> bindings)
{
    const impl::node_id root = f.id();
    return impl::evaluated(tape::current(), {&root, 1}, std::span(bindings.begin(), bindings.size())).front() != 0;
}

} // namespace taut

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
