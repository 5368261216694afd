// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>

#include <taut/types.hpp>

namespace taut::io
{

/// An orthographic camera: three unit vectors, right-handed.
struct camera
{
    vec3 right{1, 0, 0};
    vec3 up{0, 1, 0};
    vec3 toward{0, 0, 1}; ///< from the surface to the eye

    /// (to the right, up, towards the eye), in units of the surface.
    vec3 operator()(const vec3& p) const { return {glm::dot(right, p), glm::dot(up, p), glm::dot(toward, p)}; }
};

/// The directions that a surface is looked at by: what is up, and where its front is.
struct orientation
{
    vec3 up{0, 1, 0};
    vec3 front{0, 0, 1};
};

namespace impl
{

inline bool drawable(std::span<const vec3> points, const std::array<idx, 3>& cell)
{
    return std::all_of(cell.begin(), cell.end(),
                       [&](idx v)
                       {
                           if (v < 0 || static_cast<std::size_t>(v) >= points.size()) return false;
                           const vec3 p = glm::abs(points[static_cast<std::size_t>(v)]);
                           return p.x <= 1e100 && p.y <= 1e100 &&
                                  p.z <= 1e100; // false for NaN; squares of areas stay finite
                       });
}

inline vec3 area_vector(std::span<const vec3> points, const std::array<idx, 3>& cell)
{
    const vec3 a = points[static_cast<std::size_t>(cell[0])];
    return glm::cross(points[static_cast<std::size_t>(cell[1])] - a, points[static_cast<std::size_t>(cell[2])] - a) /
           2.0;
}

} // namespace impl

/// Guesses how a model stands, among the coordinate axes, since models are built along them. Up is +y, the habit of OBJ
/// files. The front is the axis that shows the most surface, twice the silhouette where nothing is hidden: the flank of
/// an animal. An open surface is looked at from outside: the sum of its area vectors, 0 for a closed one, tells the
/// sign. A surface that turns nearly all its area up (a terrain) is seen from above with -z as up.
inline orientation guess_orientation(std::span<const vec3> points, std::span<const std::array<idx, 3>> cells)
{
    vec3 sum(0), spread(0);
    for (const auto& cell : cells)
        if (impl::drawable(points, cell))
        {
            const vec3 a = impl::area_vector(points, cell);
            sum += a;
            spread += glm::abs(a);
        }
    // A tenth of head start keeps the habitual front where the choice is close.
    spread *= vec3(1, 1, 1.1);
    const int axis = spread.y > 1.5 * std::max(spread.x, spread.z) ? 1 : spread.x > spread.z ? 0 : 2;
    orientation o;
    o.front = vec3(0);
    o.front[axis] = sum[axis] < -0.05 * spread[axis] ? -1 : 1;
    o.up = axis == 1 ? vec3(0, 0, -o.front.y) : vec3(0, 1, 0);
    return o;
}

/// A camera `turn` degrees to the side of the front (180: the back) and `rise` degrees above it.
/// front and up need not be perpendicular nor of unit length; parallel or zero ones give some camera all the same.
inline camera turned_camera(const orientation& o, double turn, double rise)
{
    const auto unit = [](const vec3& v, const vec3& otherwise)
    {
        const double length = glm::length(v);
        return length > 0 && std::isfinite(length) ? v / length : otherwise;
    };
    const vec3 up = unit(o.up, {0, 1, 0});
    const vec3 any = std::abs(up.z) < 0.9 ? vec3(0, 0, 1) : vec3(1, 0, 0);
    const auto level = [&](const vec3& v) { return v - glm::dot(v, up) * up; };
    vec3 front = level(unit(o.front, any));
    front = glm::length(front) > 1e-6 ? glm::normalize(front) : glm::normalize(level(any));
    const vec3 side = glm::cross(up, front);
    const double t = turn * std::numbers::pi / 180, r = rise * std::numbers::pi / 180;
    const vec3 flat = std::cos(t) * front + std::sin(t) * side;
    camera c;
    c.toward = std::cos(r) * flat + std::sin(r) * up;
    c.right = glm::cross(up, flat);
    c.up = glm::cross(c.toward, c.right);
    return c;
}

} // namespace taut::io
