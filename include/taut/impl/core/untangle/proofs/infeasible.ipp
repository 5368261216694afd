// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/mesh/facets.hpp>
#include <taut/impl/core/untangle/proofs/empty_star.hpp>
#include <taut/impl/core/untangle/proofs/fixed_elements.hpp>
#include <taut/impl/core/untangle/proofs/infeasibility.hpp>
#include <taut/impl/core/untangle/proofs/outline_proofs.hpp>
#include <taut/impl/core/untangle/proofs/pinned_boundary.hpp>
#include <taut/untangle.hpp>

namespace taut::impl
{

/// Inner vertices that are pinned with all their neighbours so that these run around them more than once.
void judge_winding(const untangle_problem<triangle>& p, infeasibility& found);

/// Pinned vertices outside of their pinned boundary, and edges between pinned vertices that meet. Where the boundary is
/// pinned and does not meet itself, a map of positive triangles is one-to-one, so that such edges are a proof;
/// elsewhere they only say that the map covers parts twice.
void judge_places(const untangle_problem<triangle>& p, const facet_table& f, infeasibility& found);

} // namespace taut::impl

namespace taut
{

template <class Element>
impl::infeasibility find_infeasibility(const untangle_problem<Element>& problem)
{
    problem.validate();
    if (!problem.sliding.empty())
    {
        auto sure = problem;
        sure.held = problem.held_for_sure();
        sure.sliding.clear();
        return find_infeasibility(sure);
    }
    impl::infeasibility found;
    impl::judge_elements(problem, found);
    impl::judge_stars(problem, found);
    if (!problem.owners.empty()) return found; // the others are of meshes that do not overlap
    if constexpr (Element::dimension == 2) impl::judge_winding(problem, found);
    const auto f = impl::facets(problem.rest);
    impl::judge_patches(problem, f, found);
    if constexpr (Element::dimension == 2) impl::judge_places(problem, f, found);
    return found;
}

} // namespace taut

namespace taut::impl
{

void judge_winding(const untangle_problem<triangle>& p, infeasibility& found)
{
    auto ids = branch_points(p.rest.cells(), p.initial);
    if (ids.empty()) return;
    std::vector<char> movable(p.held.size(), 0); // the vertex, or one beside it
    for (const auto& t : p.rest.cells())
        if (!std::all_of(t.begin(), t.end(), [&](idx v) { return p.held.all(static_cast<std::size_t>(v)); }))
            for (const idx v : t) movable[static_cast<std::size_t>(v)] = 1;
    std::erase_if(ids, [&](idx v) { return movable[static_cast<std::size_t>(v)] != 0; });
    found.prove(infeasibility_kind::wound_star, std::move(ids),
                [](const auto& all)
                {
                    return list_ids("pinned vertex", "pinned vertices", all) +
                           " whose pinned neighbours run around it more than once; move or free them";
                });
}

void judge_places(const untangle_problem<triangle>& p, const facet_table& f, infeasibility& found)
{
    const auto boundaries = find_pinned_boundaries(p, f);
    found.prove(infeasibility_kind::outside_boundary, vertices_outside(p, boundaries),
                [](const auto& ids) {
                    return list_ids("pinned vertex", "pinned vertices", ids) +
                           " outside of the pinned boundary; move or free each";
                });

    const auto edges = pinned_edges(p.rest, [&](idx v) { return p.held.all(static_cast<std::size_t>(v)); });
    constexpr std::size_t most = 16, tests = 30'000'000; // a few are told; all pairs of many edges would take too long
    const bool any_simple =
        std::any_of(boundaries.components.begin(), boundaries.components.end(), [](const auto& c) { return c.simple; });
    std::vector<idx> proofs, warnings;
    for_each_meeting(
        edges, p.initial,
        [&](std::size_t i, std::size_t j)
        {
            auto& ids = boundaries.exclusive(edges[i], edges[j]) ? proofs : warnings;
            if (ids.size() < 4 * most)
                for (const auto& e : {edges[i], edges[j]}) ids.insert(ids.end(), e.begin(), e.end());
            return (any_simple ? proofs : warnings).size() < 4 * most;
        },
        tests);
    const auto pairs = [](const std::vector<idx>& ids)
    { return list_ids("pair", "pairs", ids, 4) + " of edges between pinned vertices that meet"; };
    found.prove(infeasibility_kind::crossing_edges, std::move(proofs),
                [&](const auto& ids)
                { return pairs(ids) + " within a pinned boundary; move or free a vertex of each"; });
    if (warnings.empty()) return;
    std::string message = pairs(warnings) + ": triangles may all be positive, but the map covers parts twice";
    found.warnings.push_back({infeasibility_kind::not_globally_injective, std::move(warnings), std::move(message)});
}

} // namespace taut::impl

namespace taut
{

template impl::infeasibility find_infeasibility(const untangle_problem<triangle>&);
template impl::infeasibility find_infeasibility(const untangle_problem<tetrahedron>&);

} // namespace taut

namespace taut::impl
{

template void judge_stars(const untangle_problem<triangle>&, infeasibility&);
template void judge_stars(const untangle_problem<tetrahedron>&, infeasibility&);

} // namespace taut::impl
