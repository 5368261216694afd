// SPDX-License-Identifier: MIT
#pragma once

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

} // namespace taut::impl
