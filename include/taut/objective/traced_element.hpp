// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include <taut/energy/any_energy.hpp>
#include <taut/symbolic/array.hpp>
#include <taut/symbolic/differentiate.hpp>

namespace taut
{

/// One element while a kernel is being traced: what its work-item loads and how S comes from it. P is the type of
/// positions, R that of the formula. S is formed in P and only then cast to R: in a thin element it is a small
/// difference of long edges, and its rounding would be the noise of the gradient (docs/numerics.md).
template <int D, class P, class R>
struct traced_element
{
    using real = sym<R>;
    using matrix = glm::mat<D, D, real>;

    /// Edges from corner 0 to corners 1..D, as columns, of an array of coordinates, formed in P.
    template <class Corners, class T>
    static glm::mat<D, D, sym<P>> edges(sym<idx> cell, const Corners& corners, const in_array<T>& x,
                                        sym<idx> cell_stride, sym<idx> vertex_stride)
    {
        const sym<idx> first = corners[cell];
        glm::mat<D, D, sym<P>> A;
        for (int k = 0; k < D; ++k)
        {
            const sym<idx> vertex = corners[cell + (k + 1) * cell_stride];
            for (int r = 0; r < D; ++r)
                A[k][r] = cast<P>(x[vertex + r * vertex_stride]) - cast<P>(x[first + r * vertex_stride]);
        }
        return A;
    }

    /// W^-1 of the cell, as its upper triangle: entry(row, column) for row <= column.
    struct rest
    {
        std::array<real, D*(D + 1) / 2> entries;

        template <class Inverse>
        rest(sym<idx> cell, const Inverse& inverse, sym<idx> cell_stride)
        {
            for (std::size_t k = 0; k < entries.size(); ++k)
                entries[k] = cast<R>(inverse[cell + static_cast<int>(k) * cell_stride]);
        }

        const real& operator()(int row, int column) const
        {
            return entries[static_cast<std::size_t>(column * (column + 1) / 2 + row)];
        }

        /// S = A W^-1 (eq. 3) in the type of A, without the products by the zeros of W^-1.
        template <class T>
        matrix shape_matrix(const glm::mat<D, D, sym<T>>& A) const
        {
            matrix S;
            for (int c = 0; c < D; ++c)
                for (int r = 0; r < D; ++r)
                {
                    sym<T> sum = A[0][r] * cast<T>((*this)(0, c));
                    for (int k = 1; k <= c; ++k) sum = sum + A[k][r] * cast<T>((*this)(k, c));
                    S[c][r] = cast<R>(sum);
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

    /// Gradient of weight * energy at S = A W^-1 with respect to the corners, corner 0 first; D entries a corner. An
    /// energy of S does not change under translation, so corner 0 takes minus the sum of the others.
    static std::array<std::array<real, D>, D + 1> corner_gradients(const any_energy& energy, const matrix& S,
                                                                   const rest& W, real measure, real weight)
    {
        const real value = weight * energy(element<real, D>{S, glm::determinant(S), measure});
        std::vector<real> entries;
        for (int c = 0; c < D; ++c)
            for (int r = 0; r < D; ++r) entries.push_back(S[c][r]);
        const auto by_entry = differentiate(value, entries);

        std::array<std::array<real, D>, D + 1> g;
        for (std::size_t r = 0; r < D; ++r)
        {
            real all = 0.0;
            for (std::size_t k = 0; k < D; ++k)
            {
                // Edge k takes part in columns k and on of S.
                real sum = by_entry[k * D + r] * W(int(k), int(k));
                for (std::size_t c = k + 1; c < D; ++c) sum = sum + by_entry[c * D + r] * W(int(k), int(c));
                g[k + 1][r] = sum;
                all = k == 0 ? sum : all + sum;
            }
            g[0][r] = -all;
        }
        return g;
    }
};

} // namespace taut
