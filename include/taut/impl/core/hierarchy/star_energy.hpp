// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <taut/energies.hpp>
#include <taut/impl/core/hierarchy/star_region.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// energy::isometric of the triangles around one vertex, summed by area, as a function of its image p, the ring fixed.
/// |S|^2 is quadratic in p and det S linear, so that derivatives are short.
class star_energy
{
public:
    /// rest: neighbours at rest, from the vertex
    star_energy(const ring_image& ring, std::span<const vec3> rest) : ring_(ring)
    {
        for (std::size_t i = 0; i < ring.triangles(); ++i)
        {
            const mat2 W = stiff_ideal(rest[i], rest[ring.next(i)]);
            triangle_[i] = {invert_upper(W), 0.5 * W[0][0] * W[1][1]};
        }
    }

    /// +infinity where a triangle is flipped.
    double value(const vec2& p) const
    {
        double sum = 0;
        for (std::size_t i = 0; i < ring_.triangles(); ++i)
        {
            const mat2 S = at(i, p);
            const double det = glm::determinant(S);
            if (!(det > 0)) return std::numeric_limits<double>::infinity();
            sum += triangle_[i].area * energy::isometric{}(element<double, 2>{S, det, triangle_[i].area});
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
            const mat2 S = at(i, p);
            const auto& [inverse, area] = triangle_[i];
            const auto psi = energy::isometric::derivatives(norm2(S), glm::determinant(S));
            // Columns of S move by s0 dp and s1 dp.
            const double s0 = -inverse[0][0], s1 = -inverse[1][0] - inverse[1][1];
            const vec2 dI = 2.0 * (s0 * S[0] + s1 * S[1]);
            const vec2 side = ring_.corner[ring_.next(i)] - ring_.corner[i];
            const vec2 dd = (inverse[0][0] * inverse[1][1]) * vec2(-side.y, side.x);
            gradient += area * (psi.by_I * dI + psi.by_d * dd);
            hessian += area * (mat2(2 * psi.by_I * (s0 * s0 + s1 * s1)) +
                               psi.by_Id * (glm::outerProduct(dI, dd) + glm::outerProduct(dd, dI)) +
                               psi.by_dd * glm::outerProduct(dd, dd)); // by_II is 0
        }
    }

private:
    struct rest_triangle
    {
        mat2 inverse; // W^-1
        double area;
    };

    mat2 at(std::size_t i, const vec2& p) const
    {
        return shape_matrix(mat2(ring_.corner[i] - p, ring_.corner[ring_.next(i)] - p), triangle_[i].inverse);
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

} // namespace taut::impl
