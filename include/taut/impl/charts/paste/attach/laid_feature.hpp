// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/charts/paste/attach/landing.hpp>
#include <taut/parameterize.hpp>
#include <taut/paste.hpp>

namespace taut::impl
{

/// Pins the rim of a feature to its correspondences in the map of a target.
inline constraints<triangle> rim_pins(const surface_region& region, std::span<const vec2> rim_uv)
{
    constraints<triangle> pins(region.surface);
    for (std::size_t i = 0; i < region.rim.size(); ++i) pins.pin(region.rim[i], rim_uv[i]);
    return pins;
}

/// Feature mapped to the surface of the target, with its rim pinned to the correspondences. With a soft seam, a band
/// along the rim is blended to it.
struct laid_feature
{
    std::vector<idx> vertices;   ///< of the feature, but for the rim
    std::vector<vec3> on_target; ///< where they lie
    std::vector<double> from_rim;

    /// Blend weight of a vertex: 1 at the rim and 0 at the end of the band, with zero slope at both ends.
    double share(std::size_t i, double width) const
    {
        const double d = std::min(1.0, from_rim[i] / width);
        return 1 - d * d * (3 - 2 * d);
    }
};

/// Those vertices whose distance from the rim is below `most`. limits: of the map. Throws paste_error.
inline laid_feature lay_feature(queue& q, const surface_region& region, std::span<const double> from_rim, double most,
                                const landing_place& place, std::span<const vec2> rim_uv, const run_limits& limits)
{
    const auto map = parameterize(q, region.surface, {.constraints = rim_pins(region, rim_uv)}, limits);
    if (!map)
        throw paste_error("the feature has no map with its rim on the target, which a soft seam needs: " +
                          map.reason() + "; choose softness 0, or another vertex, radius or scale");
    std::vector<vec3> in_plane;
    for (const vec2& p : place.uv) in_plane.emplace_back(p, 0.0);
    const auto& target = place.region.surface;
    const surface_tree tree(in_plane, target.cells());
    const auto on_rim = boundary_flags(from_rim.size(), std::span(&region.rim, 1));
    laid_feature laid;
    for (std::size_t v = 0; v < from_rim.size(); ++v)
    {
        if (on_rim[v] || from_rim[v] >= most) continue;
        laid.vertices.push_back(static_cast<idx>(v));
        laid.on_target.push_back(tree.nearest(vec3(map.uv[v], 0.0)).of(target.cells(), target.points()));
        laid.from_rim.push_back(from_rim[v]);
    }
    return laid;
}

} // namespace taut::impl
