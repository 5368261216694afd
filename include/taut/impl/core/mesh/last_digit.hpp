// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/core/core/single.hpp>
#include <taut/types.hpp>

/// In how many digits coordinates are known.
namespace taut::impl
{

/// The finite points that triangles name.
inline std::vector<vec3> named_points(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles)
{
    std::vector<char> named(points.size(), 0);
    for (const auto& t : triangles)
        for (const idx v : t)
            if (v >= 0 && static_cast<std::size_t>(v) < points.size()) named[static_cast<std::size_t>(v)] = 1;
    std::vector<vec3> result;
    for (std::size_t v = 0; v < points.size(); ++v)
        if (const vec3& p = points[v]; named[v] != 0 && std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))
            result.push_back(p);
    return result;
}

/// A quarter of the diagonal of the box around some points, which itself may be beyond the range.
inline double quarter_of_size(std::span<const vec3> points)
{
    vec3 low = points.front(), high = low;
    for (const vec3& p : points)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const vec3 quarter = 0.25 * high - 0.25 * low;
    return std::hypot(quarter.x, quarter.y, quarter.z);
}

/// Digits of a positive number before the decimal point.
inline int digits_before(double x)
{
    return static_cast<int>(std::floor(std::log10(x))) + 1;
}

constexpr int most_decimals = 12; ///< significant digits that tell of rounding

/// Significant decimal digits to which numbers in one coordinate were rounded, 6 and more; above most_decimals: they
/// were not. Those below a hundredth of the largest say nothing, as any number may have few digits there.
inline int decimals(std::span<const vec3> points, int axis)
{
    double most = 0;
    for (const vec3& p : points) most = std::max(most, std::abs(p[axis]));
    int digits = 6;
    for (const vec3& p : points)
    {
        const double x = std::abs(p[axis]);
        if (!(x > 0.01 * most)) continue;
        for (const int before = digits_before(x); digits <= most_decimals; ++digits)
        {
            const double units = x * std::pow(10.0, digits - before);
            if (!std::isfinite(units)) return most_decimals + 1;
            if (std::abs(units - std::round(units)) <= 1e-15 * units) break;
        }
    }
    return digits;
}

/// A unit of the last digit of the largest coordinates: of single precision, if all are such, else of decimal numbers,
/// as many as the axis of most digits has: short numbers of another one are round ones. 0 if they have all digits that
/// double precision has.
inline double last_digit(std::span<const vec3> points)
{
    double most = 0;
    bool single = true;
    for (const vec3& p : points)
        for (int k = 0; k < 3; ++k)
        {
            most = std::max(most, std::abs(p[k]));
            single = single && in_single(p[k]) == p[k];
        }
    if (!(most > 0)) return 0;
    if (single) return std::ldexp(1.0, std::ilogb(most) - 23);
    int digits = 0;
    for (int k = 0; k < 3; ++k) digits = std::max(digits, decimals(points, k));
    return digits > most_decimals ? 0 : std::pow(10.0, digits_before(most) - digits);
}

} // namespace taut::impl
