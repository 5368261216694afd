// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/volume_file.hpp>

namespace taut::io::impl
{

/// The same from the bytes of a file. name: in errors. Of any format but TetGen.
volume_file parse_volume(std::string bytes, volume_format format, const std::string& name = "volume data",
                         int zone = 0);

/// The same from the text of a .node file, of its .ele file and, unless that is empty, of its .face file.
volume_file parse_tetgen(std::string nodes, std::string elements, std::string faces = {},
                         const std::string& name = "volume data");

} // namespace taut::io::impl
