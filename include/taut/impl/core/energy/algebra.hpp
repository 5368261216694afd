// SPDX-License-Identifier: MIT
#pragma once

#include <taut/energies.hpp>
#include <taut/impl/core/energy/element.hpp>

/// Energies compose: `0.8 * isometric{} + 0.2 * mips_power{.p = 3}`, `shape{} * area{}`. For energies of your own,
/// bring the operators into scope with `using namespace taut::energy;`.
namespace taut::energy::impl
{

/// Energy times a number, factor * e.
template <class E>
struct scaled
{
    static constexpr bool barrier = E::barrier;
    double factor;
    E e;

    template <class T, int D>
    T operator()(const element<T, D>& x) const
    {
        return T(factor) * e(x);
    }
};

/// Sum of energies a + b. A barrier if either is one: a sum with +infinity is +infinity.
template <class A, class B>
struct sum
{
    static constexpr bool barrier = A::barrier || B::barrier;
    A a;
    B b;

    template <class T, int D>
    T operator()(const element<T, D>& x) const
    {
        return a(x) + b(x);
    }
};

/// Product of positive energies, a * b.
template <class A, class B>
struct product
{
    static constexpr bool barrier = A::barrier || B::barrier;
    A a;
    B b;

    template <class T, int D>
    T operator()(const element<T, D>& x) const
    {
        return a(x) * b(x);
    }
};

template <class E>
concept composable = energy_function<E, 2> || energy_function<E, 3>;

} // namespace taut::energy::impl

namespace taut::energy
{

template <impl::composable E>
impl::scaled<E> operator*(double factor, const E& e)
{
    return {factor, e};
}

template <impl::composable E>
impl::scaled<E> operator*(const E& e, double factor)
{
    return {factor, e};
}

template <impl::composable A, impl::composable B>
impl::sum<A, B> operator+(const A& a, const B& b)
{
    return {a, b};
}

template <impl::composable A, impl::composable B>
impl::product<A, B> operator*(const A& a, const B& b)
{
    return {a, b};
}

} // namespace taut::energy
