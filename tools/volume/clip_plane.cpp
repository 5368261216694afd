// SPDX-License-Identifier: MIT
#include "volume/clip_plane.hpp"

#include <algorithm>
#include <limits>

#include "shared/failure.hpp"
#include "volume/group_targets.hpp"

namespace taut::tools
{

std::optional<clip_plane> parse_clip(const std::string& text, std::span<const vec3> points)
{
    if (text.empty()) return std::nullopt;
    clip_plane cut;
    const int axis = text[0] - 'x';
    if (axis < 0 || axis > 2 || (text.size() > 1 && text[1] != ':'))
    {
        const auto n = numbers_of(text, 4, "--clip " + text + ": x, y, z, x:FRACTION or nx,ny,nz,d");
        cut.normal = {n[0], n[1], n[2]};
        cut.offset = n[3];
        if (!(glm::length(cut.normal) > 0))
            throw usage_error("--clip " + text + ": the normal has no length; give one that has");
        return cut;
    }
    const double part = text.size() > 1 ? numbers_of(text.substr(2), 1, "--clip " + text)[0] : 0.5;
    if (!(part >= 0 && part <= 1)) throw usage_error("--clip " + text + ": a fraction is from 0 to 1; give one");
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const vec3& p : points)
    {
        low = std::min(low, p[axis]);
        high = std::max(high, p[axis]);
    }
    cut.normal[axis] = 1;
    cut.offset = low + part * (high - low);
    return cut;
}

} // namespace taut::tools
