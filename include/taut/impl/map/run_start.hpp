// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <taut/impl/map/map_result.hpp>
#include <taut/impl/measure/describe_defects.hpp>

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
