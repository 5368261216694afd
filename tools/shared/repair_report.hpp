// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include <taut/repair.hpp>
#include <taut/surface_file.hpp>

#include "shared/text_table.hpp"

namespace taut::tools
{

/// Repairs a file, for `--repair`. Throws repair_error; mesh_error if the file has no triangle.
/// weld: repair_params::weld_tolerance; nothing: the usual one
repaired_surface repair(const io::surface_soup& soup, std::optional<double> weld = {});

/// "12 open edges lie within 3e-05 of each other; ...": what the usual tolerance would sew; empty: nothing.
/// bodies: as repair_params has them
std::string describe_near_edges(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles,
                                std::span<const idx> bodies = {});

/// An array of what was mended: "fault", "count", "ids" (of the file), "message", "repair" (what was done).
nlohmann::ordered_json to_json(std::span<const repair_finding> findings);

/// Adds a line for each.
void describe(labelled_lines& lines, std::span<const repair_finding> findings);

} // namespace taut::tools
