// SPDX-License-Identifier: MIT
#include "shared/tile_names.hpp"

#include <algorithm>
#include <string_view>
#include <system_error>

namespace taut::tools
{

namespace
{

constexpr std::string_view word = "<UDIM>";
constexpr idx most_tiles = 1000;

} // namespace

bool names_tiles(const std::string& path)
{
    return path.find(word) != path.npos;
}

std::string path_of_tile(const std::string& path, idx tile)
{
    std::string name = path;
    if (const auto at = name.find(word); at != name.npos) name.replace(at, word.size(), std::to_string(1001 + tile));
    return name;
}

std::vector<std::filesystem::path> tile_files(const std::string& path)
{
    std::vector<std::filesystem::path> files;
    if (!names_tiles(path)) return files;
    for (idx tile = 0; tile < most_tiles; ++tile)
    {
        std::error_code ignored;
        std::filesystem::path file = path_of_tile(path, tile);
        if (std::filesystem::exists(file, ignored)) files.push_back(std::move(file));
    }
    return files;
}

bool is_tile_file(const std::string& path, const std::string& file)
{
    const auto at = path.find(word);
    if (at == path.npos || file.size() != path.size() - word.size() + 4) return false;
    const std::string number = file.substr(at, 4);
    if (!std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; })) return false;
    return path_of_tile(path, static_cast<idx>(std::stoi(number)) - 1001) == file;
}

} // namespace taut::tools
