// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/exact/predicates.hpp>

/// Proof test: whether a free vertex has a position where all its triangles with two pinned corners are positive.
namespace taut::impl
{

/// The points to the left of p -> q: a x + b y + c > 0.
struct half_plane
{
    vec2 p, q;
    double a() const { return p.y - q.y; }
    double b() const { return q.x - p.x; }
    double c() const { return p.x * q.y - p.y * q.x; }
};

/// Sign of the cross product of the normals, exact.
int cross_sign(const half_plane& f, const half_plane& g);

/// Sign of det [a b c] of three half-planes, exact.
inline int determinant_sign(const half_plane& f, const half_plane& g, const half_plane& h)
{
    exact_sum<4> sum;
    // a_i b_j c_k, eight products of four coordinates.
    const auto add = [&sum](bool negative, const half_plane& i, const half_plane& j, const half_plane& k)
    {
        for (const auto& [minus_a, y] : {std::pair(false, i.p.y), std::pair(true, i.q.y)})
            for (const auto& [minus_b, x] : {std::pair(false, j.q.x), std::pair(true, j.p.x)})
            {
                const bool sign = negative ^ minus_a ^ minus_b;
                sum.add(sign, {y, x, k.p.x, k.q.y});
                sum.add(!sign, {y, x, k.p.y, k.q.x});
            }
    };
    add(false, f, g, h);
    add(false, g, h, f);
    add(false, h, f, g);
    add(true, f, h, g);
    add(true, g, f, h);
    add(true, h, g, f);
    return sum.sign();
}

/// True if no point lies in all three open half-planes, exact. By Farkas: there are l >= 0, not all zero, with
/// sum l (a, b) = 0 and sum l c <= 0. For three half-planes l are the cross products of the two other normals, and the
/// last sum is det [a b c].
inline bool contradict(const half_plane& f, const half_plane& g, const half_plane& h)
{
    const std::array<int, 3> l{cross_sign(g, h), cross_sign(h, f), cross_sign(f, g)};
    const auto [least, most] = std::minmax_element(l.begin(), l.end());
    if (*least * *most < 0 || (*least == 0 && *most == 0)) return false;
    return determinant_sign(f, g, h) * (*least + *most > 0 ? 1 : -1) <= 0;
}

/// Floating-point filter of contradict(); true where it is unsure.
inline bool may_contradict(const half_plane& f, const half_plane& g, const half_plane& h)
{
    constexpr double tolerance = 1e-9;
    const auto cross = [](const half_plane& s, const half_plane& t)
    {
        const double left = s.a() * t.b(), right = s.b() * t.a();
        const double d = left - right;
        return std::abs(d) <= tolerance * (std::abs(left) + std::abs(right)) ? 0.0 : d;
    };
    const std::array<double, 3> l{cross(g, h), cross(h, f), cross(f, g)};
    const auto [least, most] = std::minmax_element(l.begin(), l.end());
    return !(*least < 0 && *most > 0);
}

/// Clips a convex polygon to the closed half-plane.
std::vector<vec2> clip(std::span<const vec2> polygon, const half_plane& h);

/// Finds three half-planes without a common point, as numbers, or none. The result is exact. By Helly's theorem three
/// suffice; clipping in floating point tells when to search for them.
std::optional<std::array<std::size_t, 3>> find_contradiction(std::span<const half_plane> planes);

} // namespace taut::impl

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/untangle/proofs/empty_star.ipp>
#endif
