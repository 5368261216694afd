// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include <taut/certify.hpp>
#include <taut/impl/core/exact/crossings.hpp>

namespace taut::impl
{

/// Returns whether a segment meets a triangle in space, its edges and corners included. Exact; false for a triangle
/// without area.
inline bool segment_meets(const vec3& p, const vec3& q, const std::array<vec3, 3>& t)
{
    const auto& [a, b, c] = t;
    const int above_p = orient3d(a, b, c, p), above_q = orient3d(a, b, c, q);
    if (above_p * above_q > 0) return false;
    if (above_p != 0 || above_q != 0)
    {
        const int ab = orient3d(p, q, a, b), bc = orient3d(p, q, b, c), ca = orient3d(p, q, c, a);
        return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
    }
    for (int k = 0; k < 3; ++k) // in a plane: seen along an axis
    {
        const auto flat = [i = (k + 1) % 3, j = (k + 2) % 3](const vec3& x) { return vec2(x[i], x[j]); };
        const vec2 u = flat(a), v = flat(b), w = flat(c), x = flat(p), y = flat(q);
        const int side = orient2d(u, v, w);
        if (side == 0) continue;
        if (side * orient2d(u, v, x) >= 0 && side * orient2d(v, w, x) >= 0 && side * orient2d(w, u, x) >= 0)
            return true;
        return segments_meet(x, y, u, v) || segments_meet(x, y, v, w) || segments_meet(x, y, w, u);
    }
    return false;
}

/// Returns whether two triangles of a surface in space meet elsewhere than in the corner or the edge that they share:
/// they touch, cross or overlap. Exact; of a triangle without area, its edges.
///
/// x: points; s, t: indices of corners, in range
inline bool triangles_meet(std::span<const vec3> x, const std::array<idx, 3>& s, const std::array<idx, 3>& t)
{
    const auto points = [&](const std::array<idx, 3>& c) -> std::array<vec3, 3> {
        return {x[static_cast<std::size_t>(c[0])], x[static_cast<std::size_t>(c[1])],
                x[static_cast<std::size_t>(c[2])]};
    };
    const auto among = [](idx v, const std::array<idx, 3>& c) { return std::find(c.begin(), c.end(), v) != c.end(); };
    const auto shared = std::count_if(s.begin(), s.end(), [&](idx v) { return among(v, t); });
    const auto a = points(s), b = points(t);
    if (shared == 3) return true;
    if (shared == 2)
    {
        // Only where one is folded onto the other.
        std::size_t i = 0, j = 0;
        while (among(s[i], t)) ++i;
        while (among(t[j], s)) ++j;
        if (orient3d(a[0], a[1], a[2], b[j]) != 0) return false;
        for (int k = 0; k < 3; ++k)
        {
            const auto side = [&, u = (k + 1) % 3, v = (k + 2) % 3](const vec3& p)
            {
                const vec3 &e = a[(i + 1) % 3], &f = a[(i + 2) % 3];
                return orient2d(vec2(e[u], e[v]), vec2(f[u], f[v]), vec2(p[u], p[v]));
            };
            if (const int own = side(a[i]); own != 0) return own == side(b[j]);
        }
        return false;
    }
    // Of two that share a corner, an edge opposite it meets the other triangle.
    for (std::size_t k = 0; k < 3; ++k)
    {
        const std::size_t m = (k + 1) % 3, n = (k + 2) % 3;
        if ((shared == 0 || among(s[k], t)) && impl::segment_meets(a[m], a[n], b)) return true;
        if ((shared == 0 || among(t[k], s)) && impl::segment_meets(b[m], b[n], a)) return true;
    }
    return false;
}

} // namespace taut::impl
