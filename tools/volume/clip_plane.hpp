// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>

#include <taut/types.hpp>

namespace taut::tools
{

/// A plane that shows the inside of a volume: cells whose centre lies beyond it are left out.
struct clip_plane
{
    vec3 normal{0.0};
    double offset = 0; ///< points of the plane have dot(normal, x) = offset

    bool beyond(const vec3& x) const { return glm::dot(normal, x) > offset; }
};

/// "x", "y" or "z": across this axis in the middle of the points, or at a fraction of their extent, "x:0.25"; or
/// "nx,ny,nz,d". Empty: none. Throws usage_error for anything else.
std::optional<clip_plane> parse_clip(const std::string& text, std::span<const vec3> points);

} // namespace taut::tools
