// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <taut/types.hpp>

namespace taut::tools
{

/// Edges of a text, two vertices a line, from 0 to vertices - 1, with blanks or commas between; # begins a comment.
/// Each once, with the smaller vertex first, sorted. path: named in errors. Throws io_error.
std::vector<std::array<idx, 2>> parse_edges(std::string_view text, const std::string& path, idx vertices);

} // namespace taut::tools
