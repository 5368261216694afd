// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include <picture/layout_picture.hpp>
#include <picture/layout_svg.hpp>

#include "shared/outputs.hpp"
#include "shared/png.hpp"

namespace taut::tools
{

/// The bytes of the drawing of a map, SVG or PNG as the name of its file says. All else as io::layout_picture() has it.
inline std::string layout_file(const std::string& path, std::span<const vec2> uv,
                               std::span<const std::array<idx, 3>> cells, std::span<const double> distortion,
                               const std::vector<std::vector<idx>>& boundary_loops, const io::layout_style& style,
                               const io::layout_overlay& overlay)
{
    if (extension(path) == ".svg") return io::layout_svg(uv, cells, distortion, boundary_loops, style, overlay);
    return encode_png(io::layout_picture(uv, cells, distortion, boundary_loops, style, overlay));
}

} // namespace taut::tools
