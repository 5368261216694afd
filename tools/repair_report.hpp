// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <nlohmann/json.hpp>

#include <taut/io/surface_file.hpp>
#include <taut/repair/repair_surface.hpp>

#include "text_table.hpp"

namespace taut::tools
{

/// What `--repair` makes of a file. Throws repair_error; mesh_error if the file has no triangle.
repaired_surface repair(const io::surface_soup& soup, double weld_tolerance = 0);

/// An array of what was mended: "fault", "count", "ids" (of the file), "message", "repair" (what was done).
nlohmann::ordered_json to_json(std::span<const repair_finding> findings);

/// Adds a line for each.
void describe(labelled_lines& lines, std::span<const repair_finding> findings);

} // namespace taut::tools
