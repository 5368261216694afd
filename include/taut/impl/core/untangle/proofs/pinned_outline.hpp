// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include <taut/certify.hpp>
#include <taut/impl/core/exact/crossings.hpp>
#include <taut/impl/core/exact/exact_sum.hpp>

/// Consequences of the image of a pinned outline for all maps that have it.
namespace taut::impl
{

/// Twice the area (six times the volume) that an outline encloses, with an exact sign: the sum of the determinants of
/// all elements inside, whatever the free vertices do.
template <int D>
orientation enclosed(std::span<const std::array<idx, D>> outline, std::span<const vec<D>> x)
{
    exact_sum<D> sum;
    for (const auto& facet : outline)
    {
        const auto at = [&](int k) -> const vec<D>& { return x[static_cast<std::size_t>(facet[std::size_t(k)])]; };
        if constexpr (D == 2)
        {
            sum.add(false, {at(0).x, at(1).y});
            sum.add(true, {at(0).y, at(1).x});
        }
        else
            for (int i = 0; i < 3; ++i)
            {
                const int j = (i + 1) % 3, k = (i + 2) % 3;
                sum.add(false, {at(0)[i], at(1)[j], at(2)[k]});
                sum.add(true, {at(0)[i], at(1)[k], at(2)[j]});
            }
    }
    const int sign = sum.sign();
    return {sign, sign * sum.magnitude()};
}

/// Exterior angle at b of the path a, b, c, with the angle on its left in (0, 2 pi]: in [-pi, pi). Exact in its sign
/// and in telling a fold back (-pi); else to a few ulps of pi. NaN if an edge has no length or is too long to measure.
inline double exterior_angle(const vec2& a, const vec2& b, const vec2& c)
{
    constexpr double pi = std::numbers::pi;
    const vec2 d = b - a, e = c - b;
    const auto measurable = [](const vec2& v) { return finite(v) && v != vec2(0.0); };
    if (!measurable(d) || !measurable(e)) return std::numeric_limits<double>::quiet_NaN();
    const int turn = orient2d(a, b, c);
    double angle = std::atan2(e.y, e.x) - std::atan2(d.y, d.x);
    angle -= 2 * pi * std::round(angle / (2 * pi));
    if (turn == 0) return std::abs(angle) < pi / 2 ? 0 : -pi;
    // Rounding may put a sharp turn on the wrong side.
    return std::abs(angle) > pi / 2 ? std::copysign(angle, turn) : angle;
}

/// Winding number of the outline about q; nothing if q lies on it. Exact.
inline std::optional<int> winding_number(std::span<const std::array<idx, 2>> outline, std::span<const vec2> x,
                                         const vec2& q)
{
    int winding = 0;
    for (const auto& [i, j] : outline)
    {
        const vec2 &a = x[static_cast<std::size_t>(i)], &b = x[static_cast<std::size_t>(j)];
        if (std::max(a.y, b.y) < q.y || std::min(a.y, b.y) > q.y) continue;
        const int side = orient2d(a, b, q);
        if (side == 0 && between(a, b, q)) return std::nullopt;
        if (a.y <= q.y && b.y > q.y && side > 0) ++winding;
        if (b.y <= q.y && a.y > q.y && side < 0) --winding;
    }
    return winding;
}

/// Point with a negative winding number of the outline.
struct negative_winding
{
    vec2 point;
    int winding;
};

/// Searches for such a point: to the right of both edges at each crossing, where the winding number is minimal, and
/// right of each edge that overlaps another one. The result is exact; floating point only chooses the candidates.
inline std::optional<negative_winding> find_negative_winding(std::span<const std::array<idx, 2>> outline,
                                                             std::span<const vec2> x)
{
    std::optional<negative_winding> found;
    // A look costs an edge each; what costs more in all is not worth finding.
    std::size_t looks = 20'000'000 / (outline.size() + 1) + 1;
    const auto look = [&](const vec2& q)
    {
        if (!finite(q) || looks == 0) return;
        --looks;
        const auto winding = winding_number(outline, x, q);
        if (winding && *winding < 0) found = {q, *winding};
    };
    const auto at = [&](idx v) { return x[static_cast<std::size_t>(v)]; };
    const auto cross = [](const vec2& d, const vec2& e) { return d.x * e.y - d.y * e.x; };
    const auto look_at = [&](std::size_t i, std::size_t j)
    {
        const auto [a, b] = outline[i];
        const auto [c, d] = outline[j];
        if (a == d && b == c) return true; // both sides of a slit
        const vec2 e = at(b) - at(a), f = at(d) - at(c);
        const double turn = cross(e, f);
        const vec2 meet = at(a) + cross(at(c) - at(a), f) / turn * e;
        for (const double part : {0.1, 1e-3, 1e-6})
        {
            if (found) break;
            if (turn != 0) look(meet + std::copysign(part, turn) * (e - f));
            look((at(a) + at(b)) / 2.0 + part * vec2(e.y, -e.x));
            look((at(c) + at(d)) / 2.0 + part * vec2(f.y, -f.x));
        }
        return !found && looks > 0;
    };
    for_each_meeting(outline, x, look_at);
    return found;
}

} // namespace taut::impl
