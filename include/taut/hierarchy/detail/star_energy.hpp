// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <taut/core/linalg.hpp>
#include <taut/hierarchy/detail/star_region.hpp>

namespace taut::detail
{

/// Isometric distortion of the triangles around one vertex as a function of its image p, the ring fixed:
/// sum of area |S|^2 (1 + 1/det S^2). |S|^2 is quadratic in p and det S linear, so that derivatives are short.
class star_energy
{
public:
    /// rest: neighbours at rest, from the vertex
    star_energy(const ring_image& ring, std::span<const vec3> rest) : ring_(ring)
    {
        for (std::size_t i = 0; i < ring.triangles(); ++i)
        {
            const vec3 a = rest[i], b = rest[ring.next(i)];
            rest_triangle& t = triangle_[i];
            // Flat triangles at rest have no ideal element; a height near 0 makes them stiff instead.
            const double length = std::max(glm::length(a), std::numeric_limits<double>::min());
            const double height = std::max(glm::length(glm::cross(a, b)) / length, 1e-6 * length);
            t.along = 1 / length;
            t.across = 1 / height;
            t.shear = glm::dot(a, b) / (length * length);
            t.area = 0.5 * length * height;
        }
    }

    /// +infinity where a triangle is flipped.
    double value(const vec2& p) const
    {
        double sum = 0;
        for (std::size_t i = 0; i < ring_.triangles(); ++i)
        {
            const element e = at(i, p);
            if (!(e.det > 0)) return std::numeric_limits<double>::infinity();
            sum += triangle_[i].area * e.norm2 * (1 + 1 / (e.det * e.det));
        }
        return sum;
    }

    /// Gradient and Hessian, where the value is finite.
    void derivatives(const vec2& p, vec2& gradient, mat2& hessian) const
    {
        gradient = vec2(0.0);
        hessian = mat2(0.0);
        for (std::size_t i = 0; i < ring_.triangles(); ++i)
        {
            const element e = at(i, p);
            const rest_triangle& t = triangle_[i];
            // Columns of S move by s0 dp and s1 dp.
            const double s0 = -t.along, s1 = (t.shear - 1) * t.across;
            const vec2 dn = 2.0 * (s0 * e.first + s1 * e.second);
            const vec2 side = ring_.corner[ring_.next(i)] - ring_.corner[i];
            const vec2 dd = (t.along * t.across) * vec2(-side.y, side.x);
            const double r = 1 / e.det, r2 = r * r;
            gradient += t.area * ((1 + r2) * dn - 2 * e.norm2 * r2 * r * dd);
            hessian += t.area * (mat2(2 * (1 + r2) * (s0 * s0 + s1 * s1)) -
                                 2 * r2 * r * (glm::outerProduct(dn, dd) + glm::outerProduct(dd, dn)) +
                                 6 * e.norm2 * r2 * r2 * glm::outerProduct(dd, dd));
        }
    }

private:
    struct rest_triangle
    {
        double along, across, shear, area; // W = (1 / along, shear / along; 0, 1 / across)
    };
    struct element
    {
        vec2 first, second; // columns of S
        double det, norm2;
    };

    element at(std::size_t i, const vec2& p) const
    {
        const rest_triangle& t = triangle_[i];
        const vec2 a = ring_.corner[i] - p, b = ring_.corner[ring_.next(i)] - p;
        const vec2 first = t.along * a, second = t.across * (b - t.shear * a);
        return {first, second, cross(first, second), glm::dot(first, first) + glm::dot(second, second)};
    }

    const ring_image& ring_;
    std::array<rest_triangle, largest_star> triangle_;
};

/// -|H|^-1 g, with the absolute values of the eigenvalues of H: a descent direction that keeps Newton's where H is
/// positive.
inline vec2 newton_direction(const vec2& g, const mat2& h)
{
    const double mean = 0.5 * (h[0][0] + h[1][1]), half = 0.5 * (h[0][0] - h[1][1]), off = h[1][0];
    // As std::hypot, which cares for the last digit, too, and takes most of the time here.
    const double larger = std::max(std::abs(half), std::abs(off)), smaller = std::min(std::abs(half), std::abs(off));
    const double ratio = larger > 0 ? smaller / larger : 0, radius = larger * std::sqrt(1 + ratio * ratio);
    // Eigenvectors at half the angle of (half, off), and that and 90 degrees; the larger of sine and cosine first.
    vec2 u(1, 0);
    if (radius > 0)
    {
        const double large = std::sqrt(0.5 + 0.5 * std::abs(half) / radius), small = 0.5 * off / (radius * large);
        u = half >= 0 ? vec2(large, small) : vec2(std::abs(small), std::copysign(large, off));
    }
    const vec2 w(-u.y, u.x);
    const double least = 1e-8 * (std::abs(mean) + radius);
    const double l1 = std::max(std::abs(mean + radius), least), l2 = std::max(std::abs(mean - radius), least);
    return -(glm::dot(g, u) / l1 * u + glm::dot(g, w) / l2 * w);
}

/// At most `steps` Newton steps from p, each with decrease; p always sees the ring.
inline void relax(const star_energy& energy, const ring_image& ring, vec2& p, int steps)
{
    double here = energy.value(p);
    for (int step = 0; step < steps; ++step)
    {
        vec2 g;
        mat2 h;
        energy.derivatives(p, g, h);
        const vec2 d = newton_direction(g, h);
        const double slope = glm::dot(g, d);
        double t = 1;
        for (int halving = 0;; ++halving, t /= 2)
        {
            if (halving == 30) return;
            const vec2 q = p + t * d;
            const double there = energy.value(q);
            if (there <= here + 1e-4 * t * slope && ring.sees(q))
            {
                p = q;
                here = there;
                break;
            }
        }
        if (-slope < 1e-4 * here) return; // what is left to gain is not worth another step
    }
}

} // namespace taut::detail
