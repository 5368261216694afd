// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <type_traits>
#include <utility>

#include <taut/impl/symbolic/arithmetic.hpp>
#include <taut/impl/symbolic/math.hpp>
#include <taut/impl/symbolic/sym_bool.hpp>

namespace taut
{

/// A traced scalar: a handle to a node of the current tape. Code that is a template on its scalar computes with
/// T = double, and writes down what it would compute with T = sym<double>. Copying is copying an integer.
///
/// Constants convert implicitly, and narrow to T silently (a double literal in a float kernel is a float literal).
/// Everything but copying needs a tape_scope; without one it throws tape_error. A handle is good on its own tape only.
///
/// Operators: + - * / (and % of integers), comparisons, select(). Functions, found by their argument: min max abs
/// floor sqrt cbrt exp log sin cos tan atan pow.
template <impl::traceable T>
class sym : public impl::sym_arithmetic<T>, public impl::sym_math<T>
{
public:
    using value_type = T;

    /// Trivial, as GLM's unions need: `sym<T> x;` has no value yet, `sym<T> x{};` is zero.
    sym() = default;

    /// The constant. A traced integer takes integers only.
    template <class A>
        requires(std::floating_point<A> || std::integral<A>)
    &&(std::floating_point<T> || std::integral<A>)sym(A value) : id_(constant(narrow(value))) {}

    /// The handle of a node that exists; the caller vouches for its type.
    static sym of(impl::node_id id) noexcept
    {
        sym s;
        s.id_ = id;
        return s;
    }

    /// A new independent variable.
    static sym variable() { return of(tape::current().variable(impl::scalar_type_of<T>)); }

    /// The number of the node on the current tape.
    impl::node_id id() const
    {
        return id_ == 0 ? constant(T(0)) : id_; // zero bytes stand for zero
    }

private:
    static impl::node_id constant(T value)
    {
        if constexpr (std::same_as<T, double>)
            return tape::current().real_constant(value);
        else
            return tape::current().constant(value);
    }

    template <class A>
    static T narrow(A value)
    {
        if constexpr (std::same_as<T, idx>)
            if (!std::in_range<idx>(value)) throw tape_error("an integer constant does not fit into 32 bits");
        return static_cast<T>(value);
    }

    impl::node_id id_;
};

static_assert(std::is_trivially_copyable_v<sym<double>> && std::is_trivially_default_constructible_v<sym<double>>);
static_assert(sizeof(sym<double>) == sizeof(impl::node_id));

/// A choice between two numbers of the host, which are constants of the kernel.
template <std::floating_point T>
sym<T> select(sym_bool cond, T a, T b)
{
    return select(cond, sym<T>(a), sym<T>(b));
}

} // namespace taut

namespace taut::impl
{

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
