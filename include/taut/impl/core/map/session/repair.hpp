// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/core/budget.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/impl/core/untangle/local_problem.hpp>
#include <taut/untangle.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::impl
{

/// Marks the vertices around fixed ones that have not reached their targets: within `width` times their remaining
/// distance plus three edges. A flag per vertex.
template <class Element>
std::vector<char> around_moved(const untangle_problem<Element>& p, double width)
{
    const auto at = [](idx v) { return static_cast<std::size_t>(v); };
    const csr neighbours = vertex_neighbours(p.rest);
    std::vector<char> near(p.held.size(), 0);
    std::vector<idx> reached_from(p.held.size(), -1), queue;
    for (idx v = 0; v < p.rest.vertex_count(); ++v)
    {
        if (p.initial[at(v)] == p.draft[at(v)]) continue;
        double edges = 0;
        const auto ring = neighbours.row(v);
        for (const idx w : ring) edges += glm::distance(p.draft[at(v)], p.draft[at(w)]);
        const double edge = edges / static_cast<double>(std::max<std::size_t>(ring.size(), 1)),
                     reach = width * (glm::distance(p.draft[at(v)], p.initial[at(v)]) + 3 * edge);
        queue.assign(1, v);
        reached_from[at(v)] = v;
        for (std::size_t k = 0; k < queue.size(); ++k)
        {
            near[at(queue[k])] = 1;
            for (const idx w : neighbours.row(queue[k]))
                if (reached_from[at(w)] != v && glm::distance(p.draft[at(w)], p.draft[at(v)]) <= reach)
                {
                    reached_from[at(w)] = v;
                    queue.push_back(w);
                }
        }
    }
    return near;
}

/// Untangles a map whose fixed vertices could not be brought to their targets by steps; none where that fails. It
/// differs from the current one around these vertices alone, if that suffices. problem: the fixed vertices at their
/// targets in `initial`, the current injective map as `draft`. whole: the whole mesh may be untangled, too.
template <class Element>
std::optional<std::vector<vec<Element::dimension>>> repaired(const queue& q, const untangle_problem<Element>& problem,
                                                             const run_limits& limits, bool whole)
{
    constexpr int D = Element::dimension;
    const budget clock(limits.time_limit);
    const untangle_params once{.rounds = 1};
    for (const double width : {1.0, 2.0})
    {
        const auto part = part_of(problem, around_moved(problem, width));
        if (!part || !clock.in_time()) break;
        auto pull = once;
        if (D == 2) pull.stages = {"pull"}; // makes no branch points, and ends soon
        const auto found = untangle(q, part->problem, pull, {clock.left(), limits.observer});
        if (!found) continue;
        auto map = problem.draft;
        for (std::size_t k = 0; k < part->vertices.size(); ++k)
            map[static_cast<std::size_t>(part->vertices[k])] = found.map[k];
        // The rim is of the whole: the map may wind around it twice.
        if (certify<D>(problem.rest.cells(), std::span<const vec<D>>(map), {}, 0, problem.owners)) return map;
    }
    if (!whole || !clock.in_time()) return std::nullopt;
    auto found = untangle(q, problem, once, {clock.left(), limits.observer});
    if (!found) return std::nullopt;
    return std::move(found.map);
}

} // namespace taut::impl
