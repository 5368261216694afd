// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/charts/packing/occupancy.hpp>
#include <taut/impl/charts/packing/outlines.hpp>
#include <taut/impl/charts/packing/raster.hpp>
#include <taut/impl/core/core/parallel.hpp>

namespace taut::impl
{

/// Chart as the packer sees it. Lengths are its own times its density, points are relative to `centre`.
struct piece
{
    std::span<const std::array<idx, 2>> edges; ///< edges of the border, as vertices
    std::span<const vec2> uv;                  ///< coordinates of all charts, in the user's units
    std::vector<vec2> hull;                    ///< counter-clockwise
    vec2 centre{0, 0};                         ///< in the user's coordinates
    vec2 axis{1, 0};                           ///< the long side of the smallest box, unit length
    vec2 box{0, 0};                            ///< its sides along and across `axis`
    double area = 0, length = 0;               ///< area of the triangles, length of the border
    double density = 1;
    double doubt = 0; ///< bound of the rounding errors of a place

    vec2 at(idx v) const { return density * (uv[static_cast<std::size_t>(v)] - centre); }
};

/// The points that the convex hull turns at, counter-clockwise; collinear ones are left out.
inline std::vector<vec2> convex_hull(std::vector<vec2> points)
{
    const auto less = [](const vec2& a, const vec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); };
    std::sort(points.begin(), points.end(), less);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) return points;
    std::vector<vec2> hull;
    hull.reserve(points.size() + 1);
    for (int half = 0; half < 2; ++half)
    {
        const std::size_t floor = hull.size() + 1;
        for (const vec2& p : points)
        {
            while (hull.size() > floor && orient2d(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

/// The box of points in a frame: low and high corner.
inline std::array<vec2, 2> box_in(std::span<const vec2> points, const vec2& axis)
{
    vec2 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const vec2& p : points)
    {
        const vec2 q(axis.x * p.x + axis.y * p.y, axis.x * p.y - axis.y * p.x);
        low = glm::min(low, q);
        high = glm::max(high, q);
    }
    return {low, high};
}

/// The direction of a hull's side that has the box of least area.
inline vec2 tightest_axis(std::span<const vec2> hull)
{
    vec2 best(1, 0);
    double least = std::numeric_limits<double>::infinity();
    // Many sides: only those of a sample are tried, since their boxes hardly differ.
    const std::size_t step = hull.size() / 64 + 1;
    for (std::size_t k = 0; k < hull.size(); k += step)
    {
        const vec2 d = hull[(k + 1) % hull.size()] - hull[k];
        if (!(glm::length(d) > 0)) continue;
        const auto [low, high] = box_in(hull, d / glm::length(d));
        const double area = (high.x - low.x) * (high.y - low.y);
        if (!(area < least)) continue;
        least = area;
        best = d / glm::length(d);
    }
    const auto [low, high] = box_in(hull, best);
    return high.x - low.x >= high.y - low.y ? best : vec2(-best.y, best.x);
}

/// The turn from the tightest box at which a piece is in the smallest square.
inline double squarest_turn(const piece& p)
{
    constexpr int steps = 180; // of half a degree: the sides of the box of a quarter turn are the same
    double best = 0, least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < steps; ++k)
    {
        const double turn = std::numbers::pi / 2 * k / steps;
        const vec2 t(std::cos(turn), std::sin(turn));
        const auto [low, high] = box_in(p.hull, {t.x * p.axis.x - t.y * p.axis.y, t.x * p.axis.y + t.y * p.axis.x});
        if (const double side = std::max(high.x - low.x, high.y - low.y); side < least)
        {
            least = side;
            best = turn;
        }
    }
    return best;
}

/// They refer to uv and outlines.
inline std::vector<piece> make_pieces(std::span<const vec2> uv, const chart_outlines& outlines,
                                      std::span<const double> densities, bool turn)
{
    std::vector<piece> pieces(outlines.areas.size());
    parallel_for(
        pieces.size(),
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t c = begin; c < end; ++c)
            {
                piece& p = pieces[c];
                p.density = densities.empty() ? 1 : densities[c];
                p.uv = uv;
                p.edges = {outlines.edges.data() + outlines.first[c], outlines.edges.data() + outlines.first[c + 1]};
                const auto begin_of = [&](const std::array<idx, 2>& e) { return uv[static_cast<std::size_t>(e[0])]; };
                vec2 low = begin_of(p.edges.front()), high = low;
                for (const auto& e : p.edges)
                {
                    low = glm::min(low, begin_of(e));
                    high = glm::max(high, begin_of(e));
                }
                p.centre = low / 2.0 + high / 2.0;
                std::vector<vec2> points;
                points.reserve(p.edges.size());
                for (const auto& [a, b] : p.edges)
                {
                    points.push_back(p.at(a));
                    p.length += glm::length(p.at(b) - points.back());
                }
                p.hull = convex_hull(std::move(points));
                if (turn) p.axis = tightest_axis(p.hull);
                const auto [least, most] = box_in(p.hull, p.axis);
                p.box = most - least;
                p.area = p.density * p.density * outlines.areas[c];
                p.doubt =
                    16 * std::numeric_limits<double>::epsilon() * p.density * (glm::length(low) + glm::length(high));
            }
        },
        0, 1);
    return pieces;
}

/// Rotated and rasterized piece: a mask for cells of one size.
struct pose
{
    vec2 axis;   ///< direction of the chart that is turned to x
    vec2 corner; ///< lower corner of the turned chart's box, in cells; it is placed at `inset` within the mask
    vec2 size;   ///< size of that box, in cells
    room_mask mask;
};

/// Distance of charts from the borders of their masks, in cells: rounding never moves them across.
inline constexpr double inset = 1e-6;

/// The edges of a piece in a pose, in cells, its box from (inset, inset) on.
inline std::vector<std::array<vec2, 2>> posed_edges(const piece& p, const pose& at, double cells_per_length)
{
    std::vector<std::array<vec2, 2>> edges;
    edges.reserve(p.edges.size());
    const vec2 axis = cells_per_length * at.axis, shift = vec2(inset) - at.corner;
    const auto turned = [&](const vec2& x)
    { return vec2(axis.x * x.x + axis.y * x.y, axis.x * x.y - axis.y * x.x) + shift; };
    for (const auto& [a, b] : p.edges) edges.push_back({turned(p.at(a)), turned(p.at(b))});
    return edges;
}

/// turn: by this from the tightest box
inline pose make_pose(const piece& p, double turn, double cells_per_length)
{
    pose made;
    const vec2 t(std::cos(turn), std::sin(turn));
    made.axis = turn == 0 ? p.axis : vec2(t.x * p.axis.x - t.y * p.axis.y, t.x * p.axis.y + t.y * p.axis.x);
    const auto [low, high] = box_in(p.hull, made.axis);
    made.corner = cells_per_length * low;
    made.size = cells_per_length * (high - low);
    made.mask = room_mask(rasterize(posed_edges(p, made, cells_per_length), 0));
    return made;
}

} // namespace taut::impl
