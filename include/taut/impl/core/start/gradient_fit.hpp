// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <taut/impl/core/core/block_sum.hpp>
#include <taut/impl/core/core/fixed_marks.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Values at the vertices of a mesh, a vector each, whose gradients are nearest to target ones in the mean square by
/// measure: a Poisson equation for each coordinate (Yu et al. 2004), by conjugate gradients scaled by the diagonal, in
/// a number of steps of the order of the mesh's diameter in edges.
template <class Element>
class gradient_fit
{
public:
    static constexpr int D = Element::dimension;
    using values = std::vector<vec<D>>;

    /// m: the mesh. x: positions of its vertices, no element inverted.
    gradient_fit(const mesh<Element>& m, const values& x)
        : cells_(m.cells()), corners_(vertex_corners(m)), neighbours_(vertex_neighbours(m)), entries_(x.size())
    {
        basis_.resize(cells_.size());
        measure_.resize(cells_.size());
        parallel_for(cells_.size(),
                     [&](std::size_t begin, std::size_t end)
                     {
                         for (std::size_t c = begin; c < end; ++c)
                         {
                             const mat<D> A = edges(c, x), inverse = glm::transpose(glm::inverse(A));
                             auto& b = basis_[c];
                             b[0] = vec<D>(0.0);
                             for (int k = 0; k < D; ++k)
                                 b[static_cast<std::size_t>(k) + 1] = inverse[k], b[0] -= inverse[k];
                             measure_[c] = glm::determinant(A);
                         }
                     });
        sides_.resize(neighbours_.items.size());
        parallel_for(x.size(),
                     [&](std::size_t begin, std::size_t end)
                     {
                         for (std::size_t v = begin; v < end; ++v) fill_row(static_cast<idx>(v));
                     });
    }

    /// Edges of a cell from its corner 0.
    mat<D> edges(std::size_t c, const values& x) const
    {
        mat<D> A;
        const auto& cell = cells_[c];
        for (int k = 0; k < D; ++k) A[k] = x[at(cell[static_cast<std::size_t>(k) + 1])] - x[at(cell[0])];
        return A;
    }

    /// The gradient of values on a cell.
    mat<D> gradient(std::size_t c, const values& x) const
    {
        mat<D> G(0.0);
        for (std::size_t k = 0; k < basis_[c].size(); ++k) G += glm::outerProduct(x[at(cells_[c][k])], basis_[c][k]);
        return G;
    }

    /// x: initial values, with the fixed coordinates; then the fit. wanted(c): the target gradient of cell c; called
    /// from several threads. tolerance: of the residual, in the norm of its scale, by that at the start. Without fixed
    /// coordinates the mean of x, weighted by the diagonal, stays.
    template <class Wanted>
    void fit(const Wanted& wanted, const fixed_marks<D>& held, double tolerance, values& x) const
    {
        const std::size_t n = x.size();
        std::vector<mat<D>> missing(cells_.size());
        each(cells_.size(), [&](std::size_t c) { missing[c] = measure_[c] * (wanted(c) - gradient(c, x)); });
        std::vector<vec<D>> free(n, vec<D>(1.0)); // 0 where a coordinate is fixed
        values r(n), p(n), Ap(n);
        const auto scaled = [&](std::size_t v) { return entries_[v] > 0 ? r[v] / entries_[v] : vec<D>(0.0); };
        each(n,
             [&](std::size_t v)
             {
                 for (int k = 0; k < D && !held.empty(); ++k)
                     if (held.test(v, k)) free[v][k] = 0;
                 vec<D> sum(0.0);
                 for (const idx corner : corners_.row(static_cast<idx>(v)))
                 {
                     const auto c = at(corner) / sides, k = at(corner) % sides;
                     sum += missing[c] * basis_[c][k];
                 }
                 r[v] = free[v] * sum;
                 p[v] = scaled(v);
             });
        const auto dot = [n](const auto& term)
        { return block_sum<double>(n, [&](double& sum, std::size_t v) { sum += term(v); }); };
        double rz = dot([&](std::size_t v) { return glm::dot(r[v], scaled(v)); });
        const double enough = tolerance * tolerance * rz;
        for (int step = 0; step < 10000 && rz > enough; ++step)
        {
            each(n, [&](std::size_t v) { Ap[v] = free[v] * row_times(static_cast<idx>(v), p); });
            const double a = rz / dot([&](std::size_t v) { return glm::dot(p[v], Ap[v]); });
            each(n, [&](std::size_t v) { x[v] += a * p[v], r[v] -= a * Ap[v]; });
            const double next = dot([&](std::size_t v) { return glm::dot(r[v], scaled(v)); });
            const double b = next / std::exchange(rz, next);
            each(n, [&](std::size_t v) { p[v] = scaled(v) + b * p[v]; });
        }
    }

private:
    static constexpr std::size_t sides = static_cast<std::size_t>(Element::corners);

    static std::size_t at(idx v) { return static_cast<std::size_t>(v); }

    template <class Body>
    static void each(std::size_t n, const Body& body)
    {
        parallel_for(
            n,
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t k = begin; k < end; ++k) body(k);
            },
            0, 8192);
    }

    void fill_row(idx v)
    {
        const auto ring = neighbours_.row(v);
        double* const row = sides_.data() + neighbours_.offsets[at(v)];
        std::fill(row, row + ring.size(), 0.0);
        for (const idx corner : corners_.row(v))
        {
            const auto c = at(corner) / sides, k = at(corner) % sides;
            for (std::size_t j = 0; j < sides; ++j)
            {
                const double entry = measure_[c] * glm::dot(basis_[c][k], basis_[c][j]);
                if (j == k)
                    entries_[at(v)] += entry;
                else
                    row[std::lower_bound(ring.begin(), ring.end(), cells_[c][j]) - ring.begin()] += entry;
            }
        }
    }

    vec<D> row_times(idx v, const values& p) const
    {
        vec<D> sum = entries_[at(v)] * p[at(v)];
        const auto ring = neighbours_.row(v);
        const double* const row = sides_.data() + neighbours_.offsets[at(v)];
        for (std::size_t k = 0; k < ring.size(); ++k) sum += row[k] * p[at(ring[k])];
        return sum;
    }

    std::vector<typename mesh<Element>::cell> cells_;
    csr corners_, neighbours_;
    std::vector<std::array<vec<D>, Element::corners>> basis_; ///< gradients of the basis functions
    std::vector<double> measure_;                             ///< of cells, times D!
    std::vector<double> entries_;                             ///< the diagonal, one per vertex
    std::vector<double> sides_;                               ///< the others, one per neighbour
};

} // namespace taut::impl
