// SPDX-License-Identifier: MIT
#pragma once

#include <numeric>
#include <string>
#include <vector>

#include <taut/impl/map/map_result.hpp>
#include <taut/impl/map/parameterize_params.hpp>
#include <taut/impl/measure/planar_size.hpp>

namespace taut::impl
{

/// Makes a map of m of the user's coordinates: scaled to the surface's size where the boundary is free and nothing is
/// constrained, reflected where they are mirrored as a whole. unit: from the user's lengths to those of m. Throws
/// parameter_error for a wrong number.
inline start_map given_map(const mesh<triangle>& m, const ideal_elements<triangle>& ideal,
                           const parameterize_params& params, double unit, std::vector<std::string>& notes)
{
    if (params.initial.size() != m.points().size())
        throw parameter_error("initial", std::to_string(params.initial.size()) + " coordinates for " +
                                             std::to_string(m.points().size()) + " vertices");
    start_map start;
    start.uv = params.initial;
    if (params.boundary == boundary_mode::free && params.constraints.empty())
        bring_to_size(start.uv, std::accumulate(ideal.measure.begin(), ideal.measure.end(), 0.0));
    else
        for (vec2& p : start.uv) p *= unit;
    start.assess(m, ideal);
    if (start.flips.flipped == start.flips.elements && start.flips.max_det < 0)
    {
        for (vec2& p : start.uv) p.x = -p.x;
        start.assess(m, ideal);
        notes.push_back("the start was mirrored as a whole; u was negated");
    }
    return start;
}

} // namespace taut::impl
