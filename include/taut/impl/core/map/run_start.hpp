// SPDX-License-Identifier: MIT
#pragma once

#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <taut/impl/core/measure/describe_defects.hpp>
#include <taut/impl/core/measure/planar_size.hpp>
#include <taut/impl/core/start/start_map.hpp>
#include <taut/parameterize.hpp>

namespace taut::impl
{

/// Reason for which a run has no valid map.
struct refusal
{
    taut::outcome outcome;
    std::string reason;
    std::vector<idx> ids; ///< what the reason is about
};

/// Makes the refusal of a map with defects.
inline refusal refuse(outcome what, const std::string& map, const certificate& found)
{
    return {what, map + " has " + describe_defects<triangle>(found), found.flipped > 0 ? found.ids : found.branch_ids};
}

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
    assess(start, m, ideal);
    if (start.flips.flipped == start.flips.elements && start.flips.max_det < 0)
    {
        for (vec2& p : start.uv) p.x = -p.x;
        assess(start, m, ideal);
        notes.push_back("the start was mirrored as a whole; u was negated");
    }
    return start;
}

/// Start of a run of parameterize().
struct run_start
{
    start_map map;       ///< without uv where it is made on coarser levels
    bool coarse = false; ///< it is made there
    vec2 centre{0};      ///< sums far from the origin cost digits, most of all in float

    std::optional<refusal> refused; ///< the map is not injective
    bool useless = false;           ///< nor does anything bind the run to it: another start is better
    bool stopped = false;           ///< the limits ended the run; the map may be injective, or there is none

    std::vector<vec2> pin_origins;                 ///< as in map_report
    std::vector<untangle_stage_report> untangling; ///< as in map_report
    std::vector<level_report> levels;              ///< of a coarse start that failed before
    std::vector<std::string> notes;

    bool ready() const { return !refused && !useless && !stopped; }
};

} // namespace taut::impl
