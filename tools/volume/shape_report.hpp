// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "volume/volume_case.hpp"

namespace taut::tools
{

nlohmann::ordered_json shapes_json(const shape_quality& q);

/// Cells that are not valid though their corners are positive.
nlohmann::ordered_json insides_json(const volume_state& state);

/// "all valid", or how many are not.
std::string insides_text(const volume_state& state);

/// A line for people.
std::string shapes_text(const shape_quality& q);

} // namespace taut::tools
