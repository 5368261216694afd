// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <taut/impl/edit/feature_map.hpp>

namespace taut
{

/// Tessellates a feature map: the rim is kept, and the density of the triangles inside follows the detail of the map
/// (paper, section 4.1, whose tessellation shader does the same). The plane within the rim is split into square cells,
/// the roughest first, until half of the triangles are spent or nothing is rougher than a hundredth of a texel's
/// footprint; their middles and the rim get a constrained Delaunay triangulation, which has no cracks between coarse
/// and fine; its vertices are offset by the map. Roughness and positions are computed on the device. A map cuts off
/// creases, and
/// where it squeezes the feature its texels are far apart: there the feature's own vertices, and middles of its edges,
/// come in instead, the farthest first, until both are within a quarter of a footprint or the triangles are spent.
///
/// uv: of the vertices of part's region, that the map was made with. The vertices inside and all triangles are none of
/// the source (-1). Throws parameter_error, paste_error where the rim crosses itself in uv.
feature tessellate(queue& q, const feature& part, const impl::feature_map& map, std::span<const vec2> uv,
                   idx triangles);

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/edit/tessellate.ipp>
#endif
