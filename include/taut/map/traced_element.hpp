// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <vector>

#include <taut/map/any_energy.hpp>
#include <taut/symbolic/differentiate.hpp>

namespace taut
{

/// One element while a kernel is being traced: what its work-item loads and how S comes from it. P is the type of
/// positions, R that of the formula. Differences are formed in P and only then cast to R, which keeps gradients to
/// 4e-7 of their characteristic size with R = float, against 4e-5 and worse with float positions (docs/numerics.md).
template <int D, class P, class R>
struct traced_element
{
    using real = sym<R>;
    using matrix = glm::mat<D, D, real>;

    /// Edges from corner 0 to corners 1..D, as columns, of an array of coordinates (positions or directions).
    template <class Corners, class Coordinates>
    static matrix edges(sym<index> cell, const Corners& corners, const Coordinates& x, sym<index> cell_stride,
                        sym<index> vertex_stride)
    {
        const sym<index> first = corners[cell];
        matrix A;
        for (int k = 0; k < D; ++k)
        {
            const sym<index> vertex = corners[cell + (k + 1) * cell_stride];
            for (int r = 0; r < D; ++r) A[k][r] = cast<R>(x[vertex + r * vertex_stride] - x[first + r * vertex_stride]);
        }
        return A;
    }

    /// W^-1 of the cell, as its upper triangle: entry(row, column) for row <= column.
    struct rest
    {
        std::array<real, D*(D + 1) / 2> entries;

        template <class Inverse>
        rest(sym<index> cell, const Inverse& inverse, sym<index> cell_stride)
        {
            for (std::size_t k = 0; k < entries.size(); ++k)
                entries[k] = inverse[cell + static_cast<int>(k) * cell_stride];
        }

        const real& operator()(int row, int column) const
        {
            return entries[static_cast<std::size_t>(column * (column + 1) / 2 + row)];
        }

        /// S = A W^-1 (eq. 3), without the products by the zeros of W^-1.
        matrix shape_matrix(const matrix& A) const
        {
            matrix S;
            for (int c = 0; c < D; ++c)
                for (int r = 0; r < D; ++r)
                {
                    S[c][r] = A[0][r] * (*this)(0, c);
                    for (int k = 1; k <= c; ++k) S[c][r] = S[c][r] + A[k][r] * (*this)(k, c);
                }
            return S;
        }
    };

    /// weight * energy(S); +infinity where a barrier energy is outside its domain.
    static real weighted(const any_energy& energy, const matrix& S, real measure, real weight)
    {
        const real det = glm::determinant(S);
        const real value = weight * energy(element<real, D>{S, det, measure});
        if (!energy.barrier()) return value;
        return select(det > real(0.0), value, real(std::numeric_limits<double>::infinity()));
    }

    /// Gradient of weight * energy with respect to the corners, corner 0 first; D entries a corner. An energy of S does
    /// not change under translation, so corner 0 takes minus the sum of the others.
    static std::array<std::array<real, D>, D + 1> corner_gradients(const any_energy& energy, const matrix& A,
                                                                   const rest& W, real measure, real weight)
    {
        const matrix S = W.shape_matrix(A);
        const real value = weight * energy(element<real, D>{S, glm::determinant(S), measure});
        std::vector<real> unknowns;
        for (int k = 0; k < D; ++k)
            for (int r = 0; r < D; ++r) unknowns.push_back(A[k][r]);
        const auto partials = differentiate(value, unknowns);

        std::array<std::array<real, D>, D + 1> g;
        for (std::size_t r = 0; r < D; ++r)
        {
            real sum = partials[r];
            for (std::size_t k = 0; k < D; ++k)
            {
                g[k + 1][r] = partials[k * D + r];
                if (k > 0) sum = sum + partials[k * D + r];
            }
            g[0][r] = -sum;
        }
        return g;
    }
};

} // namespace taut
