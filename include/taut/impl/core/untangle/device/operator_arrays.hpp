// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <taut/impl/core/compute/lane_form.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/impl/core/mesh/order.hpp>
#include <taut/impl/core/sparse/sliced_lists.hpp>
#include <taut/queue.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::impl
{

/// Mesh and fixed coordinates in the layout of kernels/untangle.cl: renumbered for locality, moving vertices first,
/// structures of arrays of padded length.
template <class Element>
struct operator_arrays
{
    static constexpr int D = Element::dimension;

    mesh_order order;            ///< between the user's numbers and these
    std::size_t moving = 0;      ///< vertices [0, moving) have a coordinate that is not fixed
    std::size_t cell_stride = 0; ///< with at least one cell of padding
    std::size_t vertex_stride = 0;
    lane_form form;
    buffer<idx> corners; ///< (D + 1) x cell_stride: vertex of each corner; 0 for padding
    buffer<idx> held;    ///< vertex_stride: bits of the fixed coordinates; all of them for padding
    buffer<idx> offsets; ///< of the slices of `places`
    buffer<idx> places;  ///< of the contributions to each moving vertex

    operator_arrays(queue& q, const untangle_problem<Element>& p, lane_form lanes) : form(lanes)
    {
        const std::size_t n = p.held.size();
        solution_order s(p.rest, p.held.pinned());
        order = std::move(s.order);
        moving = static_cast<std::size_t>(s.free_count);
        const auto local = permute(p.rest, order);
        cell_stride = padded(local.cells().size() + 1, 256);
        vertex_stride = padded(n, 256);
        if (cell_stride > static_cast<std::size_t>(std::numeric_limits<idx>::max() / ((D + 1) * D)))
            throw size_error("rest", "more elements than 32-bit places of their corners; split the mesh");

        std::vector<idx> flat((D + 1) * cell_stride, 0), bits(vertex_stride, p.held.every);
        for (std::size_t c = 0; c < local.cells().size(); ++c)
            for (std::size_t k = 0; k <= D; ++k) flat[k * cell_stride + c] = local.cells()[c][k];
        for (std::size_t v = 0; v < n; ++v) bits[v] = p.held[old_vertex(v)];
        corners = buffer<idx>(q, flat);
        held = buffer<idx>(q, bits);
        make_lists(q, vertex_corners(local));
    }

    std::size_t old_vertex(std::size_t v) const { return static_cast<std::size_t>(order.vertices.new_to_old[v]); }
    range rows() const { return form.items(padded(moving, static_cast<std::size_t>(form.slice))); }

private:
    /// Makes sliced lists as wide as the longest of a slice; missing entries refer to the last cell, which is padding.
    void make_lists(queue& q, const csr& around)
    {
        const auto slice = static_cast<std::size_t>(form.slice);
        const std::size_t slices = vertex_stride / slice;
        std::vector<impl::list_chunk> chunks(1);
        for (std::size_t first = 0; first < moving; first += slice)
        {
            std::size_t width = 0;
            for (std::size_t v = first; v < std::min(first + slice, moving); ++v)
                width = std::max(width, around.row(static_cast<idx>(v)).size());
            chunks[0].sizes.push_back(static_cast<idx>(width * slice));
        }
        const auto starts = impl::slice_offsets(chunks, slices);
        std::vector<idx> lists(static_cast<std::size_t>(starts.back()), static_cast<idx>(cell_stride - 1));
        for (std::size_t v = 0; v < moving; ++v)
        {
            std::size_t at = static_cast<std::size_t>(starts[v / slice]) + v % slice;
            for (const idx corner : around.row(static_cast<idx>(v)))
            {
                lists[at] = corner % Element::corners * D * static_cast<idx>(cell_stride) + corner / Element::corners;
                at += slice;
            }
        }
        offsets = buffer<idx>(q, starts);
        places = buffer<idx>(q, lists);
    }
};

} // namespace taut::impl
