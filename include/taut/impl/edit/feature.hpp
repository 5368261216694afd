// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <span>

#include <taut/impl/edit/region.hpp>

namespace taut::impl
{

struct feature_map;

} // namespace taut::impl

namespace taut
{

class queue;

/// Feature cut from one surface to be pasted on another: a region with its base. The base is the plane fitted to the
/// rim; the displacement of the region from it is the detail.
struct feature
{
    /// Takes a region. Throws region_error for one whose rim encloses no area: its base has no normal.
    explicit feature(impl::surface_region of);

    impl::surface_region
        region;           ///< edges between vertices of the rim are halved: their middles are vertices -1 of the source
    vec3 centre{0.0};     ///< mean of the rim by length
    vec3 normal{0, 0, 1}; ///< unit normal of the base, to the outside
    double radius = 0;    ///< largest distance of the rim from the centre

    /// The axes of the base and its normal, as columns; right-handed.
    mat3 frame() const
    {
        const vec3 across = std::abs(normal.x) < 0.9 ? vec3(1, 0, 0) : vec3(0, 1, 0);
        const vec3 first = glm::normalize(glm::cross(across, normal));
        return {first, glm::cross(normal, first), normal};
    }

    /// Rasterizes the feature over a map of it, on the device. uv: one per vertex of the region, injective. resolution:
    /// texels along the longer side, 8 to 8192. The result is continued by some texels beyond the rim. Throws
    /// parameter_error, device_error.
    impl::feature_map rasterize(queue& q, std::span<const vec2> uv, idx resolution = 512) const;

    /// Remeshes the feature from a map: the rim is kept, and the density of the triangles inside follows the detail of
    /// the map (paper, section 4.1, whose tessellation shader does the same). The plane within the rim is split into
    /// square cells, the roughest first, until half of the triangles are spent or nothing is rougher than a hundredth
    /// of a texel's footprint; their middles and the rim get a constrained Delaunay triangulation, which has no cracks
    /// between coarse and fine; its vertices are offset by the map. Roughness and positions are computed on the device.
    /// A map cuts off creases, and where it squeezes the feature its texels are far apart: there the feature's own
    /// vertices, and middles of its edges, come in instead, the farthest first, until both are within a quarter of a
    /// footprint or the triangles are spent.
    ///
    /// uv: those that the map was made with. The vertices inside and all triangles are none of the source (-1). Throws
    /// parameter_error, paste_error where the rim crosses itself in uv.
    feature tessellate(queue& q, const impl::feature_map& map, std::span<const vec2> uv, idx triangles) const;
};

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/edit/feature.ipp>
#endif
