// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/hierarchy/reinsert.hpp>

namespace taut::impl
{

bool place(const removals<triangle>& removed, std::size_t r, std::span<const idx> numbers, std::span<const vec3> points,
           int newton_steps, std::span<vec2> uv)
{
    const auto neighbours = removed.rings.row(static_cast<idx>(r));
    const auto v = static_cast<std::size_t>(removed.vertex[r]);
    ring_image ring;
    ring.size = neighbours.size();
    ring.open = removed.open[r] != 0;
    std::array<vec3, largest_star> spokes;
    const vec3 centre = points[static_cast<std::size_t>(numbers[v])];
    for (std::size_t i = 0; i < ring.size; ++i)
    {
        const auto w = static_cast<std::size_t>(neighbours[i]);
        ring.corner[i] = uv[w];
        spokes[i] = points[static_cast<std::size_t>(numbers[w])] - centre;
    }
    const std::span<const vec3> rest(spokes.data(), ring.size);
    vec2 p = ring.open ? boundary_point(ring, rest) : mean_value_point(ring, rest);
    bool valid = ring.sees(p);
    if (!valid) valid = kernel_point(ring, static_cast<std::size_t>(removed.target[r]), p);
    if (valid && newton_steps > 0) relax(star_energy(ring, rest), ring, p, newton_steps);
    uv[v] = p;
    return valid;
}

reinsertion reinsert(const hierarchy<triangle>& h, std::size_t level, std::span<const vec3> points,
                     std::span<const vec2> coarse, const reinsert_params& params)
{
    params.validate();
    if (level >= h.steps.size()) throw parameter_error("level", "must have a coarser level");
    if (points.size() != h.levels[0].vertices.size()) throw parameter_error("points", "must be those of level 0");
    const auto& survivors = h.levels[level + 1].vertices;
    if (coarse.size() != survivors.size()) throw parameter_error("coarse", "must have one image a coarse vertex");

    const auto& numbers = h.levels[level].vertices;
    const removals<triangle>& removed = h.steps[level].removed;
    reinsertion result;
    result.uv.assign(numbers.size(), vec2(0.0));
    // Both lists of vertices are ascending.
    for (std::size_t i = 0, j = 0; j < survivors.size(); ++i)
        if (numbers[i] == survivors[j]) result.uv[i] = coarse[j++];

    std::vector<char> lost(removed.vertex.size(), 0);
    for (std::size_t round = removed.round_count(); round-- > 0;)
    {
        const auto first = static_cast<std::size_t>(removed.rounds[round]);
        const auto last = static_cast<std::size_t>(removed.rounds[round + 1]);
        // The vertices of a round are no neighbours of each other: each reads what no other writes.
        parallel_for(
            last - first,
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t r = first + begin; r < first + end; ++r)
                    lost[r] = !impl::place(removed, r, numbers, points, params.newton_steps, result.uv);
            },
            params.threads, 64);
    }
    for (std::size_t r = 0; r < lost.size(); ++r)
        if (lost[r]) result.failed.push_back(removed.vertex[r]);
    std::sort(result.failed.begin(), result.failed.end());
    return result;
}

} // namespace taut::impl
