// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <taut/types.hpp>

namespace taut::tools
{

/// Whether a path has <UDIM> in its name, in whose place each tile has its number.
bool names_tiles(const std::string& path);

/// The file of a tile: number 0 is 1001, ten in a row.
std::string path_of_tile(const std::string& path, idx tile);

/// The files of tiles, from 1001 to 2000, that are there.
std::vector<std::filesystem::path> tile_files(const std::string& path);

/// Returns whether a file, there or not, is that of one of the tiles. Both are spelled out as std::filesystem does.
bool is_tile_file(const std::string& path, const std::string& file);

} // namespace taut::tools
