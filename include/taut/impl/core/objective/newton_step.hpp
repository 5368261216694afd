// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include <taut/impl/core/energy/eigenvalue_filter.hpp>
#include <taut/symbolic.hpp>

namespace taut::impl
{

/// Newton's step -(|H| + damping m I)^-1 g in N unknowns, traced, with m the largest diagonal entry of |H|. |H| has the
/// eigenvalues of H without their signs: the step descends where H is indefinite, too, and is short along strong
/// negative curvature (Dauphin et al. 2014, "saddle-free Newton"). Not a number for H = 0.
/// type: of the numbers, f32 or f64.
template <int N>
std::array<sym<double>, static_cast<std::size_t>(N)>
newton_step(const symmetric_matrix<sym<double>, N>& H, const std::array<sym<double>, static_cast<std::size_t>(N)>& g,
            double damping, scalar_type type)
{
    using real = sym<double>;

    auto L = filtered_matrix<real, N>::of(H, type, {.absolute = true});
    real largest = 0.0;
    for (int i = 0; i < N; ++i) largest = max(largest, L(i, i));
    for (int i = 0; i < N; ++i) L(i, i) = L(i, i) + real(damping) * largest;

    // L D L' in place: pivots on the diagonal.
    for (int j = 0; j < N; ++j)
    {
        for (int k = 0; k < j; ++k) L(j, j) = L(j, j) - L(j, k) * L(j, k) * L(k, k);
        for (int i = j + 1; i < N; ++i)
        {
            for (int k = 0; k < j; ++k) L(i, j) = L(i, j) - L(i, k) * L(j, k) * L(k, k);
            L(i, j) = L(i, j) / L(j, j);
        }
    }
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    std::array<real, static_cast<std::size_t>(N)> d;
    for (int i = 0; i < N; ++i)
    {
        d[at(i)] = -g[at(i)];
        for (int k = 0; k < i; ++k) d[at(i)] = d[at(i)] - L(i, k) * d[at(k)];
    }
    for (int i = 0; i < N; ++i) d[at(i)] = d[at(i)] / L(i, i);
    for (int i = N - 2; i >= 0; --i)
        for (int k = i + 1; k < N; ++k) d[at(i)] = d[at(i)] - L(k, i) * d[at(k)];
    return d;
}

} // namespace taut::impl
