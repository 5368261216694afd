// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <span>
#include <vector>

#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Geodesic distances over the surface from the nearest of these vertices, one per vertex, in the units of the surface;
/// infinity beyond `limit` and in other components. Fronts are carried across triangles as circles around an unfolded
/// source (fast marching after Kimmel and Sethian 1998, with the update of Novotni and Klein 2002): exact in a plane
/// where the source is visible, about a percent too long on scans.
std::vector<double> geodesic_distances(const mesh<triangle>& m, const impl::csr& cells_of, std::span<const idx> from,
                                       double limit = std::numeric_limits<double>::infinity());

} // namespace taut::impl
