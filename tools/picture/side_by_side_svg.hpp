// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <taut/errors.hpp>

namespace taut::io
{

/// SVG documents of one size (layout_svg makes them) next to each other, with `gap` pixels between them: before and
/// after. Throws parameter_error for what does not begin as an SVG document.
inline std::string side_by_side_svg(std::span<const std::string> pictures, int width, int height, int gap = 0)
{
    const auto n = static_cast<int>(pictures.size());
    const std::string w = std::to_string(n * width + (n > 0 ? n - 1 : 0) * gap), h = std::to_string(height);
    std::string sheet = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "\" height=\"" + h +
                        "\" viewBox=\"0 0 " + w + ' ' + h + "\">\n";
    for (std::size_t k = 0; k < pictures.size(); ++k)
    {
        if (!pictures[k].starts_with("<svg ")) throw parameter_error("pictures", "must be SVG documents");
        sheet += "<svg x=\"" + std::to_string(static_cast<int>(k) * (width + gap)) + "\" ";
        sheet.append(pictures[k], 5);
    }
    return sheet + "</svg>\n";
}

} // namespace taut::io
