// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <taut/constrain/untangle_problem.hpp>
#include <taut/untangle/untangle_on_device.hpp>

namespace taut::detail
{

/// A map whose held vertices could not be brought to their places by steps, with them there.
struct repaired_map
{
    std::vector<vec2> map; ///< injective
    std::string note;
};

/// problem: with the held vertices at their places in `initial`, and the injective map that they come from as `draft`.
inline std::optional<repaired_map> repaired(const queue& q, const untangle_problem<triangle>& problem,
                                            const untangle_params& how)
{
    auto found = untangle(q, problem, how);
    if (!found) return std::nullopt;
    return repaired_map{std::move(found.map), "the map was untangled with the pins at their places"};
}

} // namespace taut::detail
