// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include <taut/types.hpp>

#include "shared/text_table.hpp"

namespace taut::tools
{

/// Pairs of triangles whose images have an area in common.
struct overlapping_triangles
{
    std::size_t pairs = 0;
    bool all = true;                       ///< false: there are at least so many
    std::vector<std::array<idx, 2>> first; ///< the first ones, smaller number first
};

/// Finds them, in exact arithmetic: charts that touch in a point or along a line do not count, those that coincide do.
/// Triangles without area have none. O(n log n) where few boxes meet; ends at 100,000 pairs, or at a limit of work.
///
/// cells: vertex triples, of either orientation; uv: #V finite coordinates
overlapping_triangles find_overlapping(std::span<const std::array<idx, 3>> cells, std::span<const vec2> uv);

/// The members of `taut eval --json`.
void add_overlapping(nlohmann::ordered_json& json, const overlapping_triangles& o);

void describe(labelled_lines& lines, const overlapping_triangles& o);

} // namespace taut::tools
