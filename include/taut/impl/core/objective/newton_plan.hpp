// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/mesh/layout.hpp>
#include <taut/impl/core/objective/mesh_levels.hpp>
#include <taut/impl/core/sparse/assembly_lists.hpp>
#include <taut/impl/core/sparse/multigrid_plan.hpp>

namespace taut::impl
{

/// Host part of the set-up of a newton_objective: it needs no queue, so another thread can make it while the device is
/// at work.
template <class Element>
struct newton_plan
{
    using layout_type = taut::impl::layout<Element>;
    using cells_type = std::vector<typename mesh<Element>::cell>;

    /// cells: of the mesh in layout order. transfers: from each coarser level to the next finer one, in layout order;
    /// none for a mesh too small to be coarsened; referenced data may be destroyed afterwards. fixed: one flag per
    /// vertex, or none.
    newton_plan(std::shared_ptr<const layout_type> mesh_layout, const cells_type& cells,
                const std::vector<transfer_weights>& transfers, std::span<const char> fixed, lane_form form);

    /// Makes the plan of a level.
    newton_plan(const mesh_levels<Element>& levels, std::size_t l, lane_form form)
        : newton_plan(levels.make_layout(l), levels.cells(l), levels.transfers(l), levels.fixed(l), form)
    {
    }

    std::shared_ptr<const layout_type> layout;
    multigrid_plan cycle;
    assembly_lists assembly;

private:
    /// Size of the coarsest level: in space a level of few points cannot bend, so that it is as large as a direct
    /// solver allows.
    static constexpr std::size_t dense_enough = Element::dimension == 3 ? 600 : 180;

    newton_plan(std::shared_ptr<const layout_type> mesh_layout, const cells_type& cells, const csr& around,
                const std::vector<transfer_weights>& transfers, std::span<const char> fixed, lane_form form);
};

template <class Element>
newton_plan<Element>::newton_plan(std::shared_ptr<const layout_type> mesh_layout, const cells_type& cells,
                                  const std::vector<transfer_weights>& transfers, std::span<const char> fixed,
                                  lane_form form)
    : newton_plan(mesh_layout, cells, incidence_of_cells(cells, static_cast<std::size_t>(mesh_layout->vertex_count)),
                  transfers, fixed, form)
{
}

template <class Element>
newton_plan<Element>::newton_plan(std::shared_ptr<const layout_type> mesh_layout, const cells_type& cells,
                                  const csr& around, const std::vector<transfer_weights>& transfers,
                                  std::span<const char> fixed, lane_form form)
    : layout(std::move(mesh_layout)),
      cycle(pattern_of_cells(cells, around, form.slice), Element::dimension, transfers, form,
            {.lambda_max = Element::corners, .dense_enough = dense_enough}),
      assembly(cycle.patterns.front(), Element::dimension, cells, around, layout->cell_stride, fixed)
{
}

// Compiled once, with the bodies.
extern template struct newton_plan<triangle>;

} // namespace taut::impl
