// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "bake/image_file.hpp"

namespace taut::tools
{

/// Reads an EXR file of one part. name: in messages. Throws io_error, also where the program was built without tinyexr.
image_file read_exr(std::string_view bytes, const std::string& name);

} // namespace taut::tools
