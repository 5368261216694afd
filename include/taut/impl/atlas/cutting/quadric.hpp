// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include <taut/impl/core/types.hpp>

namespace taut::impl
{

/// A sum of squared distances from planes, as a function of the point (Garland, Heckbert 1997, "Surface simplification
/// using quadric error metrics").
struct quadric
{
    std::array<double, 6> second{}; ///< xx, xy, xz, yy, yz, zz
    vec3 first{0.0};
    double constant = 0;

    /// Adds the plane dot(n, x) + d = 0, n a unit vector.
    void add(const vec3& n, double d, double weight)
    {
        std::size_t i = 0;
        for (int r = 0; r < 3; ++r)
            for (int c = r; c < 3; ++c) second[i++] += weight * n[r] * n[c];
        first += weight * d * n;
        constant += weight * d * d;
    }

    quadric& operator+=(const quadric& other)
    {
        for (std::size_t i = 0; i < second.size(); ++i) second[i] += other.second[i];
        first += other.first;
        constant += other.constant;
        return *this;
    }

    double operator()(const vec3& x) const
    {
        const auto& q = second;
        return q[0] * x.x * x.x + q[3] * x.y * x.y + q[5] * x.z * x.z +
               2 * (q[1] * x.x * x.y + q[2] * x.x * x.z + q[4] * x.y * x.z + glm::dot(first, x)) + constant;
    }
};

} // namespace taut::impl
