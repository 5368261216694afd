// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include <taut/impl/core/energy/symmetric_matrix.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Derivatives by the corners of a triangle or tetrahedron from those by S = A W^-1; `inverse` is W^-1, upper
/// triangular. By translation invariance corner 0 has minus the sum of the others.
template <int D>
std::array<vec<D>, D + 1> corner_gradient(const mat<D>& by_shape, const mat<D>& inverse)
{
    const mat<D> edges = by_shape * glm::transpose(inverse);
    std::array<vec<D>, D + 1> g{};
    for (int e = 0; e < D; ++e)
    {
        g[static_cast<std::size_t>(e) + 1] = edges[e];
        g[0] -= edges[e];
    }
    return g;
}

/// by_shape: over the entries of S by columns. The result: over coordinate r of corner k as number D * k + r.
template <int D>
auto corner_hessian(const symmetric_matrix<double, D * D>& by_shape, const mat<D>& inverse)
{
    constexpr std::size_t N = static_cast<std::size_t>(D) * (D + 1);
    std::array<std::array<double, N>, N> H;
    const auto set = [&](int k, int r, int l, int s, double value)
    {
        const auto i = static_cast<std::size_t>(D * k + r), j = static_cast<std::size_t>(D * l + s);
        H[i][j] = H[j][i] = value;
    };
    const mat<D> transposed = glm::transpose(inverse);
    for (int s = 0; s < D; ++s)
        for (int r = 0; r <= s; ++r)
        {
            mat<D> between; // coordinates r and s of the columns of S
            for (int b = 0; b < D; ++b)
                for (int c = 0; c < D; ++c) between[b][c] = by_shape(D * c + r, D * b + s);
            const mat<D> edges = inverse * between * transposed;
            vec<D> rows(0.0);
            double all = 0;
            for (int f = 0; f < D; ++f)
            {
                double column = 0;
                for (int e = 0; e < D; ++e)
                {
                    set(e + 1, r, f + 1, s, edges[f][e]);
                    column += edges[f][e];
                }
                set(0, r, f + 1, s, -column);
                rows += edges[f];
                all += column;
            }
            for (int e = 0; e < D; ++e) set(e + 1, r, 0, s, -rows[e]);
            set(0, r, 0, s, all);
        }
    return H;
}

} // namespace taut::impl
