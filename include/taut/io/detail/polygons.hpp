// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <taut/core/types.hpp>

namespace taut::io::detail
{

/// Splits polygons into triangles by cutting off corners ("ears"), each time the one with the shortest diagonal among
/// those whose triangle faces as the polygon does and holds no other corner. A quad is thus cut along its shorter
/// inner diagonal. Polygons that cross themselves are split somehow. O(n^2) for n corners.
class ear_clipper
{
public:
    /// Larger polygons are split into a fan, so that the time for a file stays linear.
    static constexpr std::size_t most_corners = 256;

    /// Calls triangle(a, b, c) with positions in the polygon, n - 2 times. The orientation is kept.
    template <class Triangle>
    void split(std::span<const vec3> polygon, Triangle triangle)
    {
        const std::size_t n = polygon.size();
        if (n > most_corners)
        {
            for (std::size_t i = 2; i < n; ++i) triangle(0, i - 1, i);
            return;
        }
        p_ = polygon;
        start();
        std::size_t first = 0; // some corner that is left
        for (std::size_t left = n; left > 3; --left)
        {
            const std::size_t i = best(first, left);
            triangle(before_[i], i, after_[i]);
            first = after_[i];
            before_[after_[i]] = before_[i];
            after_[before_[i]] = after_[i];
            // A cut can change only the neighbours: other blocked corners are blocked by reflex ones, which stay.
            look_at(before_[i], left - 1);
            look_at(after_[i], left - 1);
        }
        triangle(before_[first], first, after_[first]);
    }

private:
    /// Flattens the polygon along the main axis of its normal, so that it turns counter-clockwise.
    void start()
    {
        const std::size_t n = p_.size();
        x_.resize(n);
        before_.resize(n);
        after_.resize(n);
        ear_.resize(n);
        vec3 normal(0.0); // Newell: twice the area vector, also of polygons that are not flat
        for (std::size_t i = 0; i < n; ++i) normal += glm::cross(p_[i] - p_[0], p_[(i + 1) % n] - p_[0]);
        int axis = 2;
        for (int k = 0; k < 2; ++k)
            if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
        const double sign = normal[axis] < 0 ? -1 : 1;
        for (std::size_t i = 0; i < n; ++i)
        {
            const vec3 p = p_[i] - p_[0];
            x_[i] = vec2(sign * p[(axis + 1) % 3], p[(axis + 2) % 3]);
            before_[i] = (i + n - 1) % n;
            after_[i] = (i + 1) % n;
        }
        for (std::size_t i = 0; i < n; ++i) look_at(i, n);
    }

    static double turn(vec2 a, vec2 b, vec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

    /// Decides whether corner i is an ear; `left` corners are left.
    void look_at(std::size_t i, std::size_t left)
    {
        const vec2 a = x_[before_[i]], b = x_[i], c = x_[after_[i]];
        ear_[i] = turn(a, b, c) > 0;
        for (std::size_t k = after_[after_[i]], m = 3; ear_[i] && m < left; k = after_[k], ++m)
            ear_[i] = !(turn(a, b, x_[k]) >= 0 && turn(b, c, x_[k]) >= 0 && turn(c, a, x_[k]) >= 0);
    }

    /// The ear with the shortest diagonal; if nothing is an ear, the corner with the shortest diagonal.
    std::size_t best(std::size_t first, std::size_t left) const
    {
        std::size_t result = first;
        double shortest = std::numeric_limits<double>::infinity();
        bool found = false;
        for (std::size_t i = first, m = 0; m < left; i = after_[i], ++m)
        {
            const vec3 d = p_[after_[i]] - p_[before_[i]];
            const double length = glm::dot(d, d);
            const bool ear = ear_[i] != 0;
            if ((ear && !found) || (ear == found && length < shortest))
            {
                result = i;
                shortest = length;
                found = ear;
            }
        }
        return result;
    }

    std::span<const vec3> p_;
    std::vector<vec2> x_;                     // flattened
    std::vector<std::size_t> before_, after_; // neighbours among the corners that are left
    std::vector<char> ear_;
};

} // namespace taut::io::detail
