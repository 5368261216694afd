// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <taut/errors.hpp>

namespace taut::impl
{

/// Distributes points over a closed polygon in proportion to `lengths`: the first at its first corner, point k + 1 at
/// lengths[k] further on. Corners between two points are cut off.
/// Throws constraint_error (bad_polygon); parameter_error for lengths that are negative or sum to zero.
inline std::vector<vec2> along_polygon(std::span<const vec2> polygon, std::span<const double> lengths)
{
    const auto refuse = [](const char* why)
    { throw constraint_error(constraint_error::bad_polygon, {}, std::string("the polygon ") + why); };
    if (polygon.size() < 3) refuse("has fewer than three corners; give it at least three");
    const std::size_t n = polygon.size();
    std::vector<double> upto(n + 1, 0.0); // length of the polygon before each corner
    for (std::size_t k = 0; k < n; ++k) upto[k + 1] = upto[k] + glm::distance(polygon[k], polygon[(k + 1) % n]);
    if (!std::isfinite(upto[n])) refuse("has a corner that is not finite, or too far away; give finite coordinates");
    if (!(upto[n] > 0)) refuse("has no length; give it corners that differ");

    double total = 0;
    for (const double length : lengths)
    {
        if (!(length >= 0)) throw parameter_error("lengths", "must not be negative");
        total += length;
    }
    if (!(total > 0) || !std::isfinite(total)) throw parameter_error("lengths", "must have a positive, finite sum");

    std::vector<vec2> points;
    points.reserve(lengths.size());
    double passed = 0;
    std::size_t side = 0;
    for (const double length : lengths)
    {
        const double s = upto[n] * (passed / total);
        while (side + 1 < n && upto[side + 1] <= s) ++side;
        const double along = upto[side + 1] > upto[side] ? (s - upto[side]) / (upto[side + 1] - upto[side]) : 0;
        const vec2 &a = polygon[side], &b = polygon[(side + 1) % n];
        points.push_back(along <= 0 ? a : along >= 1 ? b : a + along * (b - a));
        passed += length;
    }
    return points;
}

} // namespace taut::impl
