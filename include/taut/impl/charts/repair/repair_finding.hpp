// SPDX-License-Identifier: MIT
#pragma once

#include <taut/repair.hpp>

namespace taut::impl
{

/// Number of ids of a defect of a kind: 2 for edges and pairs.
constexpr int ids_each(repair_kind kind)
{
    return kind == repair_kind::duplicate_cell || kind == repair_kind::coincident_vertex ||
                   kind == repair_kind::not_orientable || kind == repair_kind::non_manifold_facet
               ? 2
               : 1;
}

/// Returns whether no charts can be made of a mesh with this defect. Other defects are repaired, too.
constexpr bool is_fault(repair_kind kind)
{
    return kind != repair_kind::unreferenced_vertex && kind != repair_kind::coincident_vertex &&
           kind != repair_kind::contradicting_normal;
}

} // namespace taut::impl
