// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bake/bake_options.hpp"

namespace taut::tools
{

/// What a run says of one texture.
struct baked_report
{
    std::string name;
    texture_content content = texture_content::colour;
    idx width = 0, height = 0, channels = 0;                   ///< of the largest tile
    std::size_t tiles = 0, texels = 0, covered = 0, bytes = 0; ///< of all tiles: texels, those in charts, of the files
    std::optional<double> largest, rms;                        ///< differences through both atlases, from 0 to 1
    std::size_t compared = 0, unlike = 0;                      ///< texels; numbers that are none before or after
};

/// What a run says.
struct bake_report
{
    std::string device, device_label;
    std::size_t triangles = 0, left_out = 0;
    std::vector<baked_report> textures;
    std::vector<std::string> notes;
    double read = 0, bake = 0, write = 0, total = 0;
};

nlohmann::ordered_json to_json(const bake_report& r, const bake_options& o);

/// Prints notes, and returns the report as text.
std::string text_of(const bake_report& r, const bake_options& o);

} // namespace taut::tools
