// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <taut/types.hpp>

namespace taut::impl
{

/// Similarity transform x -> to + scale * rotation * (x - from).
struct similarity_transform
{
    vec3 from{0.0}, to{0.0};
    mat3 rotation{1.0};
    double scale = 1;

    vec3 operator()(const vec3& x) const { return to + scale * (rotation * (x - from)); }
};

/// The rotation by an angle in radians about an axis of length 1.
inline mat3 rotation_about(const vec3& axis, double angle)
{
    const double c = std::cos(angle), s = std::sin(angle);
    mat3 m;
    for (int k = 0; k < 3; ++k)
    {
        vec3 e(0.0);
        e[k] = 1;
        m[k] = c * e + s * glm::cross(axis, e) + (1 - c) * axis[k] * axis;
    }
    return m;
}

/// The smallest rotation that takes one direction to another; both of length 1.
inline mat3 rotation_between(const vec3& a, const vec3& b)
{
    const vec3 axis = glm::cross(a, b);
    const double s = glm::length(axis), c = glm::dot(a, b);
    if (s > 1e-12) return rotation_about(axis / s, std::atan2(s, c));
    if (c > 0) return mat3(1.0);
    const vec3 other = std::abs(a.x) < 0.9 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    return rotation_about(glm::normalize(glm::cross(a, other)), 3.14159265358979323846);
}

} // namespace taut::impl
