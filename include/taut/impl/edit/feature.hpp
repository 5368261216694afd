// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include <taut/impl/edit/surface/split_chords.hpp>

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

inline feature::feature(impl::surface_region of) : region(impl::split_chords(std::move(of)))
{
    const auto& rim = region.rim;
    const auto at = [&](std::size_t i) -> const vec3&
    { return region.surface.points()[static_cast<std::size_t>(rim[i % rim.size()])]; };
    double length = 0;
    for (std::size_t i = 0; i < rim.size(); ++i)
    {
        const double edge = glm::distance(at(i), at(i + 1));
        centre += edge / 2 * (at(i) + at(i + 1));
        length += edge;
    }
    centre /= length;
    vec3 area(0.0); // twice the vector area of the rim (Newell)
    for (std::size_t i = 0; i < rim.size(); ++i)
    {
        area += glm::cross(at(i) - centre, at(i + 1) - centre);
        radius = std::max(radius, glm::distance(at(i), centre));
    }
    if (!(glm::length(area) > 1e-6 * length * length))
        throw region_error(
            region_error::flat, {},
            "the rim of the region encloses no area, so that its base has no direction; choose another one");
    normal = glm::normalize(area);
}

} // namespace taut
