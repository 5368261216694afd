// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <taut/types.hpp>

namespace taut::tools
{

/// Numbers of faces in a text, from 0, with blanks, commas or ends of lines between; # begins a comment.
/// path: named in errors. Throws io_error.
std::vector<idx> parse_faces(std::string_view text, const std::string& path);

/// The same of a file.
std::vector<idx> read_faces(const std::string& path);

} // namespace taut::tools
