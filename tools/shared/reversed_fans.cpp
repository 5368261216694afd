// SPDX-License-Identifier: MIT
#include "shared/reversed_fans.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/files/surface/surface_file.hpp>

namespace taut::tools
{

std::size_t count_reversed_fans(const io::impl::file_faces& faces, std::span<const vec2> at)
{
    std::size_t found = 0, first = 0;
    for (const idx size : faces.sizes)
    {
        const auto own = at.subspan(first, static_cast<std::size_t>(size));
        first += own.size();
        if (size < 4 || std::any_of(own.begin(), own.end(), [](const vec2& x) { return std::isnan(x.x); })) continue;
        bool positive = true;
        for (std::size_t i = 1; i + 1 < own.size(); ++i)
            positive = positive && impl::orient2d(own[0], own[i], own[i + 1]) > 0;
        found += positive ? 0 : 1;
    }
    return found;
}

std::size_t count_reversed_fans(const io::impl::file_faces& faces, const mesh<triangle>& cut, std::span<const vec2> uv)
{
    if (faces.triangles.empty()) return 0;
    std::vector<vec2> at(faces.corners.size(), vec2(std::numeric_limits<double>::quiet_NaN()));
    for (std::size_t c = 0; c < cut.cells().size(); ++c)
        for (std::size_t k = 0; k < 3; ++k) at[faces.corner(c, k)] = uv[static_cast<std::size_t>(cut.cells()[c][k])];
    return count_reversed_fans(faces, at);
}

void note_reversed_fans(std::vector<std::string>& notes, std::size_t count)
{
    if (count > 0)
        notes.push_back(std::to_string(count) + (count == 1 ? " concave polygon has" : " concave polygons have") +
                        " triangles that flip in the map under fan triangulation from the first corner; triangulate "
                        "them, or begin them with other corners");
}

} // namespace taut::tools
