// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include <taut/certify.hpp>
#include <taut/impl/core/exact/cell_validity.hpp>
#include <taut/impl/core/exact/predicates.hpp>

namespace taut
{

cell_validity validity_of_cell(std::span<const vec3> corners, std::size_t boxes)
{
    if (!std::all_of(corners.begin(), corners.end(), [](const vec3& p) { return impl::finite(p); }))
        return cell_validity::invalid;
    if (impl::has_bad_corner(corners)) return cell_validity::invalid;
    if (corners.size() == 8) return impl::validity_of(impl::hexahedron_jacobian(corners), boxes);
    if (corners.size() == 5) return impl::validity_of(impl::pyramid_jacobian(corners), boxes);
    auto worst = cell_validity::valid;
    if (corners.size() == 6)
        for (const auto& p : impl::wedge_jacobians(corners))
        {
            const auto here = impl::validity_of(p, boxes);
            if (here == cell_validity::invalid) return here;
            if (here == cell_validity::undecided) worst = here;
        }
    return worst;
}

} // namespace taut
