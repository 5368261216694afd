// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <taut/measure/shape_quality.hpp>

namespace taut::tools
{

nlohmann::ordered_json shapes_json(const shape_quality& q);

/// A line for people.
std::string shapes_text(const shape_quality& q);

} // namespace taut::tools
