// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <taut/core/types.hpp>

namespace taut::tools
{

/// Numbers of faces in a file, from 0, with blanks, commas or ends of lines between; # begins a comment.
/// Throws io_error.
std::vector<idx> read_faces(const std::string& path);

} // namespace taut::tools
