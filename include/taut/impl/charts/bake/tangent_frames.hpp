// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include <taut/bake.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Angle at corner k of a triangle.
inline double corner_angle(const std::array<vec3, 3>& x, std::size_t k)
{
    const vec3 a = x[(k + 1) % 3] - x[k], b = x[(k + 2) % 3] - x[k];
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

inline vec3 normalised(const vec3& x, const vec3& otherwise = vec3(0.0))
{
    const double length = glm::length(x);
    return length > 0 && std::isfinite(length) ? x / length : otherwise;
}

/// A direction across a unit vector.
inline vec3 any_across(const vec3& n)
{
    return normalised(glm::cross(n, std::abs(n.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0)), vec3(1, 0, 0));
}

/// Places of the corners of a triangle.
inline std::array<vec3, 3> corners_of(std::span<const vec3> points, const std::array<idx, 3>& t)
{
    return {points[static_cast<std::size_t>(t[0])], points[static_cast<std::size_t>(t[1])],
            points[static_cast<std::size_t>(t[2])]};
}

} // namespace taut::impl
