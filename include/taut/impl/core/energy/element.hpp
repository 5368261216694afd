// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>

#include <taut/energies.hpp>

namespace taut::energy::impl
{

/// Energy density: a function of one element, smooth where det S > 0. `barrier` says that it tends to infinity as det S
/// tends to 0 from above, and is +infinity (never clamped) from there on.
template <class E, int D = 2>
concept energy_function = requires(const E& e, const element<double, D>& x)
{
    {
        e(x)
        } -> std::convertible_to<double>;
    {
        E::barrier
        } -> std::convertible_to<bool>;
};

template <class E>
concept energy_of_some_dimension = energy_function<E, 2> || energy_function<E, 3>;

} // namespace taut::energy::impl
