// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include <taut/cell_data.hpp>
#include <taut/impl/core/core/padded.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/impl/core/mesh/order.hpp>

namespace taut::impl
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

    mesh_order order;   ///< between the user's numbers and these
    idx free_count = 0; ///< vertices [0, free_count) move, the rest are pinned
    idx vertex_count = 0;
    idx cell_count = 0;
    double scale = 1; ///< user's lengths -> lengths here; a power of two, so that undoing it is exact
    std::size_t cell_stride = 0, vertex_stride = 0;
    std::vector<idx> corners;    ///< (D + 1) x cell_stride: vertex of each corner
    std::vector<double> inverse; ///< triangle_size x cell_stride: W^-1 by columns, (0,0) (0,1) (1,1) (0,2) ...
    std::vector<double> measure; ///< cell_stride: rest measure in these units; 0 for padding
    csr vertex_corners;          ///< corners of each vertex, as corners * cell + k

    std::vector<double> weight; ///< cell_stride or none: cell_data::weights
    std::size_t attribute_count = 0;
    std::vector<double> attributes; ///< attribute_count x cell_stride
    std::vector<double>
        frames; ///< D * D x cell_stride or none: by columns, the user's axes in the frame of the ideal cell

    /// Renumbers the mesh: free vertices first, otherwise for locality.
    /// `pinned`: one flag per vertex of the mesh, or empty. Throws mesh_error for degenerate cells.
    explicit layout(const mesh<Element>& m, const std::vector<bool>& pinned = {}) : layout(m, solution_order(m, pinned))
    {
    }

    /// Makes the layout of a mesh in its final order: its first `free` vertices move, the rest are pinned. `numbers`
    /// leads from the user's mesh to this one; identity_order() where they are the same. Throws mesh_error for
    /// degenerate cells.
    layout(const mesh<Element>& local, mesh_order numbers, idx free)
        : layout(local, std::move(numbers), free, ideal_elements<Element>(local))
    {
    }

    /// The same with ideal elements that are not those of the mesh.
    layout(const mesh<Element>& local, mesh_order numbers, idx free, const ideal_elements<Element>& ideal)
        : layout(local, std::move(numbers), free, ideal,
                 usual_scale(static_cast<double>(local.cell_count()),
                             std::accumulate(ideal.measure.begin(), ideal.measure.end(), 0.0)))
    {
    }

    /// The same with a scale, a power of two: of a part of a mesh that of the whole.
    layout(const mesh<Element>& local, mesh_order numbers, idx free, const ideal_elements<Element>& ideal,
           double by_scale);

    /// The scale of cells that have a measure together: a power of two.
    static double usual_scale(double cells, double measure)
    {
        return std::exp2(std::round(std::log2(cells / measure) / D));
    }

    /// Takes what the user says of the cells, in the numbers of this layout; local: the mesh that it is of. Throws
    /// parameter_error.
    void attach(const cell_data& data, const mesh<Element>& local);

    /// Coordinates here, D x vertex_stride, from the user's.
    std::vector<double> to_local(const std::vector<vec<D>>& x) const;

    /// The user's coordinates from those here; exact inverse of to_local.
    std::vector<vec<D>> to_user(const std::vector<double>& local) const;

private:
    /// Braces, which evaluate from left to right: the order is used before it is moved.
    layout(const mesh<Element>& m, solution_order s) : layout{permute(m, s.order), std::move(s.order), s.free_count} {}

    /// The arrays from the cells, padded with copies of the last one of measure 0: their energy is as finite as that
    /// cell's and counts nothing, and no step they allow is shorter.
    void spread(const std::vector<typename mesh<Element>::cell>& cells, const ideal_elements<Element>& ideal);
};

template <class Element>
layout<Element>::layout(const mesh<Element>& local, mesh_order numbers, idx free, const ideal_elements<Element>& ideal,
                        double by_scale)
    : order(std::move(numbers)),
      free_count(free),
      vertex_count(local.vertex_count()),
      cell_count(local.cell_count()),
      scale(by_scale),
      vertex_corners(taut::impl::vertex_corners(local))
{
    cell_stride = padded(local.cells().size(), step);
    vertex_stride = padded(local.points().size(), step);
    spread(local.cells(), ideal);
}

template <class Element>
void layout<Element>::attach(const cell_data& data, const mesh<Element>& local)
{
    data.validate(local.cells().size());
    const auto from = [&](std::size_t c) { return std::min(c, local.cells().size() - 1); };
    attribute_count = data.attribute_count;
    attributes.resize(attribute_count * cell_stride);
    weight.resize(data.weights.empty() ? 0 : cell_stride);
    frames.resize(data.directions.empty() ? 0 : D * D * cell_stride);
    for (std::size_t c = 0; c < cell_stride; ++c)
    {
        if (!weight.empty()) weight[c] = data.weights[from(c)];
        for (std::size_t k = 0; k < attribute_count; ++k)
            attributes[k * cell_stride + c] = data.attributes[from(c) * attribute_count + k];
        if (frames.empty()) continue;
        const auto frame = Element::frame(local.rest(static_cast<idx>(from(c))), data.directions[from(c)]);
        for (int column = 0; column < D; ++column)
            for (int row = 0; row < D; ++row)
                frames[static_cast<std::size_t>(column * D + row) * cell_stride + c] = frame[column][row];
    }
}

template <class Element>
std::vector<double> layout<Element>::to_local(const std::vector<vec<D>>& x) const
{
    std::vector<double> local(D * vertex_stride, 0.0);
    parallel_for(x.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t v = begin; v < end; ++v)
                     {
                         const vec<D>& p = x[static_cast<std::size_t>(order.vertices.new_to_old[v])];
                         for (int k = 0; k < D; ++k)
                             local[static_cast<std::size_t>(k) * vertex_stride + v] = p[k] * scale;
                     }
                 });
    return local;
}

template <class Element>
auto layout<Element>::to_user(const std::vector<double>& local) const -> std::vector<vec<D>>
{
    std::vector<vec<D>> x(static_cast<std::size_t>(vertex_count));
    parallel_for(x.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t v = begin; v < end; ++v)
                     {
                         vec<D>& p = x[static_cast<std::size_t>(order.vertices.new_to_old[v])];
                         for (int k = 0; k < D; ++k)
                             p[k] = local[static_cast<std::size_t>(k) * vertex_stride + v] / scale;
                     }
                 });
    return x;
}

template <class Element>
void layout<Element>::spread(const std::vector<typename mesh<Element>::cell>& cells,
                             const ideal_elements<Element>& ideal)
{
    corners.resize((D + 1) * cell_stride);
    inverse.resize(triangle_size * cell_stride);
    measure.resize(cell_stride);
    const double measure_scale = std::pow(scale, D), unscale = 1 / scale; // exact: a power of two
    parallel_for(cell_stride,
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t c = begin; c < end; ++c)
                     {
                         const std::size_t from = std::min(c, cells.size() - 1);
                         for (std::size_t k = 0; k <= D; ++k) corners[k * cell_stride + c] = cells[from][k];
                         std::size_t entry = 0;
                         for (int column = 0; column < D; ++column)
                             for (int row = 0; row <= column; ++row)
                                 inverse[entry++ * cell_stride + c] = ideal.inverse[from][column][row] * unscale;
                         measure[c] = c < cells.size() ? ideal.measure[c] * measure_scale : 0.0;
                     }
                 });
}

// Compiled once, with the bodies.
extern template struct layout<triangle>;
extern template struct layout<tetrahedron>;

} // namespace taut::impl
