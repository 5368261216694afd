// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include <taut/types.hpp>

namespace taut::impl
{

/// Maximum valence of removed vertices: few triangulations of larger stars are good, and the arrays below stay small.
constexpr std::size_t largest_star = 10;

/// Star of a vertex, flattened to the plane with the vertex at the origin: distances from it are kept, angles are
/// scaled to fill the full turn (as in MAPS; Lee et al. 1998). A planar star keeps its shape.
struct flat_star
{
    std::size_t size = 0;                  ///< neighbours
    bool open = false;                     ///< of a boundary vertex: the first and the last neighbour are not joined
    double angle = 0;                      ///< sum of the angles in space
    vec3 normal{0.0};                      ///< area-weighted
    std::array<vec3, largest_star> spoke;  ///< neighbours in space, from the vertex
    std::array<vec2, largest_star> corner; ///< neighbours in the plane

    std::size_t triangles() const { return open ? size - 1 : size; }
    std::size_t next(std::size_t i) const { return i + 1 < size ? i + 1 : 0; }
};

/// Flattens the star of a vertex with at most largest_star neighbours.
inline flat_star flatten(std::span<const vec3> points, idx centre, std::span<const idx> ring, bool open)
{
    flat_star s;
    s.size = ring.size();
    s.open = open;
    const vec3 origin = points[static_cast<std::size_t>(centre)];
    for (std::size_t i = 0; i < s.size; ++i) s.spoke[i] = points[static_cast<std::size_t>(ring[i])] - origin;
    std::array<double, largest_star> direction{};
    for (std::size_t i = 0; i < s.triangles(); ++i)
    {
        const vec3 a = s.spoke[i], b = s.spoke[s.next(i)], c = glm::cross(a, b);
        s.normal += c;
        s.angle += std::atan2(glm::length(c), glm::dot(a, b));
        if (i + 1 < s.size) direction[i + 1] = s.angle;
    }
    // A boundary vertex keeps its angle, so that an outline in the plane keeps its shape, unless the star would
    // overlap itself.
    constexpr double pi = std::numbers::pi;
    const double scale = !open ? 2 * pi / s.angle : s.angle > 1.6 * pi ? 1.6 * pi / s.angle : 1.0;
    for (std::size_t i = 0; i < s.size; ++i)
    {
        const double r = glm::length(s.spoke[i]), t = scale * direction[i];
        s.corner[i] = r * vec2(std::cos(t), std::sin(t));
    }
    return s;
}

/// Twice the signed area spanned by two vectors of the plane.
inline double cross(const vec2& a, const vec2& b)
{
    return a.x * b.y - a.y * b.x;
}

} // namespace taut::impl
