// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <taut/types.hpp>

namespace taut::impl
{

/// Additive moments of pieces of a surface, from which the distortion of a union is estimated.
struct chart_moments
{
    double area = 0;
    vec3 normal = vec3(0.0);           ///< unit normals, summed by area
    std::array<double, 6> spread = {}; ///< their products xx, yy, zz, xy, xz, yz, too
    double perimeter = 0;              ///< perimeter of single pieces; less what lies between them

    /// Moments of a triangle, by twice its area times its normal.
    static chart_moments of_triangle(const vec3& doubled)
    {
        chart_moments m;
        const double length = glm::length(doubled);
        if (!(length > 0)) return m;
        const vec3 n = doubled / length;
        m.area = length / 2;
        m.normal = m.area * n;
        m.spread = {m.area * n.x * n.x, m.area * n.y * n.y, m.area * n.z * n.z,
                    m.area * n.x * n.y, m.area * n.x * n.z, m.area * n.y * n.z};
        return m;
    }

    chart_moments& operator+=(const chart_moments& o)
    {
        area += o.area;
        normal += o.normal;
        for (std::size_t i = 0; i < spread.size(); ++i) spread[i] += o.spread[i];
        perimeter += o.perimeter;
        return *this;
    }

    /// Estimate of the isometric energy above its minimum, times area, of the flattened piece.
    double strain() const
    {
        // The least eigenvalue of the covariance of normals is 0 where they keep an angle to an axis (planes,
        // cylinders, cones), and r^4 / 48 on a spherical cap of radius r.
        const auto [least, sum] = covariance();
        // Small pieces keep away from creases, though a fold costs nothing.
        constexpr double flatness = 0.01;
        // A finger with its tip has normals as a cylinder, but less perimeter than any flat piece of its area.
        constexpr double closed = 1e3;
        const double flat = perimeter * perimeter / (4 * std::numbers::pi);
        const double excess = area < flat ? 0 : area < closed * flat ? area / flat - 1 : closed;
        return area > 0 ? area * (least + flatness * sum + 0.2 * excess * excess) : 0;
    }

private:
    /// Least eigenvalue and trace of the covariance of the normals, by Cardano's formula.
    std::array<double, 2> covariance() const
    {
        const vec3 n = normal / area;
        const double xx = spread[0] / area - n.x * n.x, yy = spread[1] / area - n.y * n.y,
                     zz = spread[2] / area - n.z * n.z, xy = spread[3] / area - n.x * n.y,
                     xz = spread[4] / area - n.x * n.z, yz = spread[5] / area - n.y * n.z;
        const double sum = xx + yy + zz, mean = sum / 3;
        const double a = xx - mean, b = yy - mean, c = zz - mean;
        const double p = std::sqrt((a * a + b * b + c * c + 2 * (xy * xy + xz * xz + yz * yz)) / 6);
        if (!(p > 0)) return {std::max(0.0, mean), std::max(0.0, sum)};
        const double det = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
        const double angle = std::acos(std::clamp(det / (2 * p * p * p), -1.0, 1.0)) / 3;
        const double least = mean + 2 * p * std::cos(angle + 2 * std::numbers::pi / 3);
        return {std::max(0.0, least), std::max(0.0, sum)};
    }
};

} // namespace taut::impl
