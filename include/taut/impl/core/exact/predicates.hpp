// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <taut/impl/core/exact/exact_sum.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Orientation of a simplex: an exact sign and the determinant of its edges to a few ulps.
struct orientation
{
    int sign = 0;   ///< -1, 0 or 1; exact for finite coordinates, 0 if one is not finite
    double det = 0; ///< determinant with that sign (it may underflow to 0 or overflow), NaN if not finite
};

/// det = det[b - a, c - a], by exact arithmetic: b x c + c x a + a x b.
orientation exact_orient(const vec2& a, const vec2& b, const vec2& c);

/// det[b - a, c - a, d - a] as the four minors of the homogeneous 4 x 4 determinant.
orientation exact_orient(const vec3& a, const vec3& b, const vec3& c, const vec3& d);

/// Floating-point filter: returns whether the sign is certain, with fused products or without; else the exact sum
/// decides.
/// `terms` is the sum of the magnitudes of the terms, `ulps` bounds the relative error, `underflow` the absolute one.
inline bool decided(double det, double terms, double ulps, double underflow)
{
    constexpr double u = std::numeric_limits<double>::epsilon() / 2;
    return std::abs(det) > ulps * u * terms + underflow && terms < std::numeric_limits<double>::max();
}

/// Tests finiteness by bits, as compilers may assume that every number is finite.
inline bool finite(double x)
{
    return (std::bit_cast<std::uint64_t>(x) >> 52U & 0x7ffU) != 0x7ffU;
}
inline bool finite(const vec2& p)
{
    return finite(p.x) && finite(p.y);
}
inline bool finite(const vec3& p)
{
    return finite(p.x) && finite(p.y) && finite(p.z);
}

/// Orientation of triangle (a, b, c): det[b - a, c - a], twice its area, positive if counter-clockwise.
/// The sign is exact for every finite input. A floating-point filter first (Shewchuk 1997 has the error bounds,
/// used here with a margin), the exact sum where the filter cannot tell.
inline orientation orient(const vec2& a, const vec2& b, const vec2& c)
{
    const double left = (b.x - a.x) * (c.y - a.y);
    const double right = (b.y - a.y) * (c.x - a.x);
    const double det = left - right;
    if (impl::decided(det, std::abs(left) + std::abs(right), 6, std::numeric_limits<double>::min()))
        return {det > 0 ? 1 : -1, det};
    if (!impl::finite(a) || !impl::finite(b) || !impl::finite(c)) return {0, std::numeric_limits<double>::quiet_NaN()};
    return impl::exact_orient(a, b, c);
}

/// Orientation of tetrahedron (a, b, c, d): det[b - a, c - a, d - a], six times its volume, exact sign as above.
inline orientation orient(const vec3& a, const vec3& b, const vec3& c, const vec3& d)
{
    const vec3 e = b - a;
    const vec3 f = c - a;
    const vec3 g = d - a;
    double det = 0;
    double terms = 0;
    for (int x = 0; x < 3; ++x)
    {
        const int y = (x + 1) % 3;
        const int z = (x + 2) % 3;
        const double left = f[y] * g[z];
        const double right = f[z] * g[y];
        det += e[x] * (left - right);
        terms += std::abs(e[x]) * (std::abs(left) + std::abs(right));
    }
    // A product that underflows is off by at most one tiny number, then scaled by the third factor.
    const double scale = 1 + std::abs(e.x) + std::abs(e.y) + std::abs(e.z);
    if (impl::decided(det, terms, 14, scale * std::numeric_limits<double>::min())) return {det > 0 ? 1 : -1, det};
    if (!impl::finite(a) || !impl::finite(b) || !impl::finite(c) || !impl::finite(d))
        return {0, std::numeric_limits<double>::quiet_NaN()};
    return impl::exact_orient(a, b, c, d);
}

/// Exact sign of orient(a, b, c).
inline int orient2d(const vec2& a, const vec2& b, const vec2& c)
{
    return orient(a, b, c).sign;
}

/// Exact sign of orient(a, b, c, d).
inline int orient3d(const vec3& a, const vec3& b, const vec3& c, const vec3& d)
{
    return orient(a, b, c, d).sign;
}

} // namespace taut::impl
