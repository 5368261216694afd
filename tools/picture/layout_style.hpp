// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <picture/palette.hpp>

namespace taut::io
{

/// Style of a UV layout, as PNG pixels or SVG. The defaults suit a README.
struct layout_style
{
    int width = 1200; ///< pixels, [1, 16384 / samples]
    int height = 900; ///< pixels, [1, 16384 / samples]
    int samples = 3;  ///< antialiasing: samples^2 colours a pixel, [1, 8]; 1 draws hard edges

    palette colors = wished_palette();

    std::string title = {};            ///< first line; a map's name
    std::optional<double> energy = {}; ///< stated in the caption when given
    std::string census = {};           ///< how many cells, in words, where faces are parts of cells; else faces count
    std::string note = {};             ///< last line of the caption when not empty

    double lowest = 1;                     ///< distortion at the pale end of the scale
    double highest = 10;                   ///< distortion at the dark end; what lies beyond has the same colour
    std::string scale = "distortion";      ///< name of the number, over the legend
    std::string formula = "max(s1, 1/s2)"; ///< what it is, below the name

    std::size_t most_edges = 5000; ///< triangle edges are drawn for fewer faces than this
    std::size_t most_rings = 25;   ///< that many flipped faces or fewer are ringed, so that tiny ones are found
};

} // namespace taut::io
