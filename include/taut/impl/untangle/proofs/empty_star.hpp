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
inline int cross_sign(const half_plane& f, const half_plane& g)
{
    exact_sum<2> sum;
    // (pf.y - qf.y) (qg.x - pg.x) - (pg.y - qg.y) (qf.x - pf.x)
    const auto add = [&sum](bool negative, const half_plane& s, const half_plane& t)
    {
        sum.add(negative, {s.p.y, t.q.x});
        sum.add(!negative, {s.p.y, t.p.x});
        sum.add(!negative, {s.q.y, t.q.x});
        sum.add(negative, {s.q.y, t.p.x});
    };
    add(false, f, g);
    add(true, g, f);
    return sum.sign();
}

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
inline std::vector<vec2> clip(std::span<const vec2> polygon, const half_plane& h)
{
    std::vector<vec2> kept;
    for (std::size_t k = 0; k < polygon.size(); ++k)
    {
        const vec2 &x = polygon[k], &y = polygon[(k + 1) % polygon.size()];
        const double at_x = orient(h.p, h.q, x).det, at_y = orient(h.p, h.q, y).det;
        if (at_x >= 0) kept.push_back(x);
        if ((at_x < 0) != (at_y < 0)) kept.push_back(x + at_x / (at_x - at_y) * (y - x));
    }
    return kept;
}

/// Finds three half-planes without a common point, as numbers, or none. The result is exact. By Helly's theorem three
/// suffice; clipping in floating point tells when to search for them.
inline std::optional<std::array<std::size_t, 3>> find_contradiction(std::span<const half_plane> planes)
{
    constexpr std::size_t most = 2000; // clipping takes the square of their number
    if (planes.size() < 3 || planes.size() > most) return std::nullopt;
    vec2 low = planes[0].p, high = low;
    for (const auto& h : planes)
    {
        low = glm::min(low, glm::min(h.p, h.q));
        high = glm::max(high, glm::max(h.p, h.q));
    }
    // A free boundary vertex may find its place far outside.
    const vec2 room = 1e3 * vec2(high.x - low.x + high.y - low.y);
    low -= room;
    high += room;
    std::vector<vec2> left{low, {high.x, low.y}, high, {low.x, high.y}};
    std::size_t tries = 1 << 20; // enough for all triples of 180; what costs more is not worth finding
    for (std::size_t k = 0; k < planes.size(); ++k)
    {
        left = clip(left, planes[k]);
        double area = 0, size = 0;
        for (std::size_t i = 2; i < left.size(); ++i) area += orient(left[0], left[i - 1], left[i]).det;
        for (const vec2& x : left) size = std::max({size, std::abs(x.x - low.x), std::abs(x.y - low.y)});
        if (area > 1e-12 * size * size) continue;
        for (std::size_t j = 0; j < k; ++j)
            for (std::size_t i = 0; i < j; ++i)
            {
                if (tries-- == 0) return std::nullopt;
                if (may_contradict(planes[i], planes[j], planes[k]) && contradict(planes[i], planes[j], planes[k]))
                    return std::array{i, j, k};
            }
    }
    return std::nullopt;
}

} // namespace taut::impl
