// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/impl/core/untangle/proofs/pinned_boundary.hpp>

namespace taut::impl
{

pinned_boundaries find_pinned_boundaries(const untangle_problem<triangle>& p, const facet_table& f)
{
    const auto at = [](idx i) { return static_cast<std::size_t>(i); };
    pinned_boundaries b;
    b.of_vertex.assign(p.initial.size(), -1);
    b.on_boundary.assign(p.initial.size(), 0);
    if (!f.oriented()) return b;
    disjoint_sets sets(p.rest.vertex_count());
    for (const auto& t : p.rest.cells())
        for (const idx v : {t[1], t[2]}) sets.join(t[0], v);

    std::vector<idx> number(p.initial.size(), -1); // of the component, by the vertex that stands for it
    for (const auto& loop : boundary_loops(p.rest, f))
    {
        idx& n = number[at(sets.find(loop[0]))];
        if (n < 0)
        {
            n = static_cast<idx>(b.components.size());
            b.components.emplace_back();
        }
        auto& c = b.components[at(n)];
        c.simple = ++c.loops == 1;
        for (std::size_t k = 0; k < loop.size(); ++k)
        {
            c.edges.push_back({loop[k], loop[(k + 1) % loop.size()]});
            c.pinned = c.pinned && p.held.all(at(loop[k]));
            c.simple = c.simple && !b.on_boundary[at(loop[k])];
            b.on_boundary[at(loop[k])] = 1;
        }
    }
    for (auto& c : b.components)
    {
        c.simple = c.simple && c.pinned;
        if (c.simple) for_each_meeting(c.edges, p.initial, [&c](std::size_t, std::size_t) { return c.simple = false; });
    }
    for (const auto& t : p.rest.cells())
        for (const idx v : t)
            if (const idx n = number[at(sets.find(v))]; n >= 0 && b.components[at(n)].pinned) b.of_vertex[at(v)] = n;
    return b;
}

} // namespace taut::impl
