// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include <taut/impl/core/start/boundary_polygon.hpp>

namespace taut::impl
{

std::vector<vec2> on_square(std::span<const double> gaps, std::span<const std::pair<std::size_t, std::size_t>> dividing)
{
    const std::size_t n = gaps.size();
    auto corner = square_corners(gaps, 0);
    auto flat = flat_sides(corner, dividing);
    const auto total = [](const std::array<int, 4>& c) { return c[0] + c[1] + c[2] + c[3]; };
    // Starts beyond the first quarter would repeat the same squares, up to rounding to vertices.
    const std::size_t limit = dividing.empty() ? 0 : std::min<std::size_t>(corner[1], 1000);
    for (std::size_t start = 1; start < limit && total(flat) > 0; ++start)
    {
        const auto other = square_corners(gaps, start);
        if (const auto count = flat_sides(other, dividing); total(count) < total(flat))
        {
            corner = other;
            flat = count;
        }
    }

    constexpr double bulge = 0.1; // height of the parabola over half a side: corners stay well below 180 degrees
    constexpr std::array<std::array<double, 4>, 4> frame{
        {{-1, -1, 1, 0}, {1, -1, 0, 1}, {1, 1, -1, 0}, {-1, 1, 0, -1}}};
    std::vector<vec2> p(n);
    for (std::size_t side = 0; side < 4; ++side)
    {
        const vec2 origin(frame[side][0], frame[side][1]);
        const vec2 along(frame[side][2], frame[side][3]);
        const vec2 outward(along.y, -along.x);
        double length = 0;
        for (std::size_t k = corner[side]; k < corner[side + 1]; ++k) length += gaps[k % n];
        double s = 0;
        for (std::size_t k = corner[side]; k < corner[side + 1]; ++k)
        {
            const double t = s / length;
            p[k % n] = origin + 2 * t * along;
            if (flat[side] > 0) p[k % n] += 4 * t * (1 - t) * bulge * outward;
            s += gaps[k % n];
        }
    }
    return p;
}

std::vector<vec2> boundary_polygon(std::span<const vec3> loop, const boundary_params& params, double area,
                                   std::span<const std::pair<std::size_t, std::size_t>> dividing)
{
    if (loop.size() < 3) throw parameter_error("loop", "a boundary loop has at least three vertices");
    if (!(area > 0) || !std::isfinite(area)) throw parameter_error("area", "must be positive and finite");
    const bool square = params.shape == boundary_shape::square && loop.size() > 3;
    for (double even = 0;; even = even == 0 ? 1e-6 : std::min(1.0, even * 10))
    {
        const auto gaps = impl::boundary_gaps(loop, params.spacing, even);
        auto p = square ? impl::on_square(gaps, dividing) : impl::on_circle(gaps);
        const double scale = std::sqrt(2 * area / impl::polygon_area2(p));
        for (auto& q : p) q *= scale;
        if (even >= 1 || impl::convex(p, square)) return p;
    }
}

} // namespace taut::impl
