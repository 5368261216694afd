// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/untangle/proofs/empty_star.hpp>

namespace taut::impl
{

int cross_sign(const half_plane& f, const half_plane& g)
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

std::vector<vec2> clip(std::span<const vec2> polygon, const half_plane& h)
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

std::optional<std::array<std::size_t, 3>> find_contradiction(std::span<const half_plane> planes)
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
