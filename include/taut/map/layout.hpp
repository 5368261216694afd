// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <taut/mesh/incidence.hpp>
#include <taut/mesh/order.hpp>
#include <taut/mesh/padding.hpp>

namespace taut
{

/// A mesh as the kernels see it: vertices and cells renumbered for locality with the free vertices first, ideal
/// elements in units in which the mean cell has a measure near 1, everything as structures of arrays of padded length.
///
/// Entry k of cell c stands at [k * cell_stride + c]; coordinate k of vertex v at [k * vertex_stride + v].
template <class Element>
struct layout
{
    static constexpr int D = Element::dimension;
    static constexpr int triangle_size = D * (D + 1) / 2; ///< entries of an upper triangular D x D matrix
    static constexpr std::size_t step = 256;              ///< strides are multiples of this

    mesh_order order;     ///< between the user's numbers and these
    index free_count = 0; ///< vertices [0, free_count) move, the rest are pinned
    index vertex_count = 0;
    index cell_count = 0;
    double scale = 1; ///< user's lengths -> lengths here; a power of two, so that undoing it is exact
    std::size_t cell_stride = 0, vertex_stride = 0;
    std::vector<index> corners;  ///< (D + 1) x cell_stride: vertex of each corner
    std::vector<double> inverse; ///< triangle_size x cell_stride: W^-1 by columns, (0,0) (0,1) (1,1) (0,2) ...
    std::vector<double> measure; ///< cell_stride: rest measure in these units; 0 for padding
    csr vertex_corners;          ///< corners of each vertex, as corners * cell + k

    /// `pinned`: one flag a vertex of the mesh, or empty. Throws mesh_error for degenerate cells.
    explicit layout(const mesh<Element>& m, const std::vector<bool>& pinned = {})
        : order(locality_order(m)), vertex_count(m.vertex_count()), cell_count(m.cell_count())
    {
        put_free_vertices_first(pinned);
        const mesh<Element> local = permute(m, order);
        vertex_corners = taut::vertex_corners(local);

        ideal_elements<Element> ideal(local);
        const double total = std::accumulate(ideal.measure.begin(), ideal.measure.end(), 0.0);
        scale = std::exp2(std::round(std::log2(static_cast<double>(cell_count) / total) / D));
        for (auto& w : ideal.inverse) w /= scale;
        for (auto& a : ideal.measure) a *= std::pow(scale, D);

        auto cells = local.cells();
        pad<Element>(cells, ideal, step);
        cell_stride = cells.size();
        vertex_stride = round_up(static_cast<std::size_t>(vertex_count), step);
        measure = std::move(ideal.measure);
        spread(cells, ideal.inverse);
    }

    /// Coordinates here, D x vertex_stride, from the user's.
    std::vector<double> to_local(const std::vector<vec<D>>& x) const
    {
        std::vector<double> local(D * vertex_stride, 0.0);
        for (std::size_t v = 0; v < x.size(); ++v)
        {
            const auto old = static_cast<std::size_t>(order.vertices.new_to_old[v]);
            for (int k = 0; k < D; ++k) local[static_cast<std::size_t>(k) * vertex_stride + v] = x[old][k] * scale;
        }
        return local;
    }

    /// The user's coordinates from those here; exact inverse of to_local.
    std::vector<vec<D>> to_user(const std::vector<double>& local) const
    {
        std::vector<vec<D>> x(static_cast<std::size_t>(vertex_count));
        for (std::size_t v = 0; v < x.size(); ++v)
        {
            auto& p = x[static_cast<std::size_t>(order.vertices.new_to_old[v])];
            for (int k = 0; k < D; ++k) p[k] = local[static_cast<std::size_t>(k) * vertex_stride + v] / scale;
        }
        return x;
    }

private:
    void put_free_vertices_first(const std::vector<bool>& pinned)
    {
        free_count = vertex_count;
        if (pinned.empty()) return;
        auto numbers = order.vertices.new_to_old;
        const auto first_pinned = std::stable_partition(
            numbers.begin(), numbers.end(), [&](index old) { return !pinned[static_cast<std::size_t>(old)]; });
        free_count = static_cast<index>(first_pinned - numbers.begin());
        order.vertices = permutation(std::move(numbers));
    }

    void spread(const std::vector<typename mesh<Element>::cell>& cells, const std::vector<mat<D>>& inverses)
    {
        corners.resize((D + 1) * cell_stride);
        inverse.resize(triangle_size * cell_stride);
        for (std::size_t c = 0; c < cell_stride; ++c)
        {
            for (std::size_t k = 0; k <= D; ++k) corners[k * cell_stride + c] = cells[c][k];
            std::size_t entry = 0;
            for (int column = 0; column < D; ++column)
                for (int row = 0; row <= column; ++row) inverse[entry++ * cell_stride + c] = inverses[c][column][row];
        }
    }
};

} // namespace taut
