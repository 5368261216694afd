// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/impl/core/untangle/proofs/infeasibility.hpp>
#include <taut/mesh.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::impl
{

/// Edges, faces and cells to split, cells first and edges last, so that an infeasible problem may become feasible.
struct mending_splits
{
    std::vector<std::vector<idx>> simplices; ///< vertices ascending
    std::string obstacle;                    ///< the proof that no split inside the mesh refutes; empty: there is none
};

/// Simplices of a mesh that may be split: inner ones, as the boundary is not changed.
template <class Element>
class inner_simplices
{
public:
    explicit inner_simplices(const mesh<Element>& m) : mesh_(m), around_(vertex_cells(m))
    {
        for (auto facet : boundary_facets(m))
        {
            std::sort(facet.begin(), facet.end());
            outer_.insert(std::vector<idx>(facet.begin(), facet.end()));
            for (std::size_t i = 0; i < facet.size(); ++i)
                for (std::size_t j = 0; j < i; ++j) outer_.insert({facet[j], facet[i]});
        }
    }

    /// Adds a simplex to be split. Returns false if it lies on the boundary, or is none of the mesh.
    bool split(std::vector<idx> simplex)
    {
        std::sort(simplex.begin(), simplex.end());
        if (outer_.count(simplex) != 0 || !present(simplex)) return false;
        chosen_.insert(std::move(simplex));
        return true;
    }

    /// Adds the edges among these vertices that pass `take(a, b)`; returns their number.
    template <class Take>
    std::size_t split_edges(std::span<const idx> vertices, const Take& take)
    {
        std::size_t count = 0;
        for (std::size_t i = 0; i < vertices.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (take(vertices[i], vertices[j]) && split({vertices[i], vertices[j]})) ++count;
        return count;
    }

    const csr& around() const { return around_; } ///< cells of vertices

    /// Takes the collected splits, cells first.
    std::vector<std::vector<idx>> take() const
    {
        std::vector<std::vector<idx>> all(chosen_.begin(), chosen_.end());
        std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
        return all;
    }

private:
    bool present(const std::vector<idx>& simplex) const
    {
        const auto cells = around_.row(simplex.front());
        return std::any_of(cells.begin(), cells.end(),
                           [&](idx c)
                           {
                               const auto& t = mesh_.cells()[static_cast<std::size_t>(c)];
                               return std::all_of(simplex.begin(), simplex.end(),
                                                  [&](idx v) { return std::find(t.begin(), t.end(), v) != t.end(); });
                           });
    }

    const mesh<Element>& mesh_;
    csr around_;
    std::set<std::vector<idx>> outer_, chosen_;
};

/// Splits an element that fixed corners make flat or invert: its inner edges between them, or else its facets.
template <class Element>
bool split_element(const untangle_problem<Element>& p, idx c, inner_simplices<Element>& inner)
{
    const auto& cell = p.rest.cells()[static_cast<std::size_t>(c)];
    const auto held = [&](idx v) { return p.held.any(static_cast<std::size_t>(v)); };
    const auto apart = [&](idx a, idx b)
    { return held(a) && held(b) && p.initial[static_cast<std::size_t>(a)] != p.initial[static_cast<std::size_t>(b)]; };
    if (inner.split_edges(cell, apart) > 0) return true;
    bool any = false;
    if constexpr (Element::dimension == 3)
        for (const auto& facet : Element::facets)
            any = inner.split({cell[static_cast<std::size_t>(facet[0])], cell[static_cast<std::size_t>(facet[1])],
                               cell[static_cast<std::size_t>(facet[2])]}) ||
                  any;
    return any;
}

/// Splits the edges of a vertex to its fixed neighbours, which leave it no position, or wind about it.
template <class Element>
bool split_star(const untangle_problem<Element>& p, idx v, inner_simplices<Element>& inner)
{
    const auto to_held = [&](idx a, idx b)
    {
        const idx other = a == v ? b : a;
        return (a == v || b == v) && p.held.any(static_cast<std::size_t>(other));
    };
    std::size_t count = 0;
    for (const idx c : inner.around().row(v))
        count += inner.split_edges(p.rest.cells()[static_cast<std::size_t>(c)], to_held);
    return count > 0;
}

/// Returns whether splits were found against a proof.
template <class Element>
bool split_against(const untangle_problem<Element>& p, const infeasibility_finding& proof,
                   inner_simplices<Element>& inner)
{
    const auto& ids = proof.ids;
    bool all = true;
    switch (proof.kind)
    {
    case infeasibility_kind::inverted_element:
    case infeasibility_kind::flat_element:
        for (const idx c : ids) all = split_element(p, c, inner) && all;
        return all;
    case infeasibility_kind::empty_star: // a vertex and cells
        for (std::size_t k = 0; k < ids.size(); k += Element::dimension + 2) all = split_star(p, ids[k], inner) && all;
        return all;
    case infeasibility_kind::wound_star:
        for (const idx v : ids) all = split_star(p, v, inner) && all;
        return all;
    case infeasibility_kind::crossing_edges: // two edges, of which one may lie on the boundary
        for (std::size_t k = 0; k + 3 < ids.size(); k += 4)
        {
            const bool first = inner.split({ids[k], ids[k + 1]}), second = inner.split({ids[k + 2], ids[k + 3]});
            all = (first || second) && all;
        }
        return all;
    case infeasibility_kind::crowded_edge: // two vertices and cells
        return inner.split({ids[0], ids[1]});
    case infeasibility_kind::outline_measure:
    case infeasibility_kind::outline_turning:
    case infeasibility_kind::outline_winding:
    {
        std::size_t count = 0;
        if constexpr (Element::dimension == 2) // vertices in their order
            for (std::size_t k = 0; k + 1 < ids.size(); ++k) count += inner.split({ids[k], ids[k + 1]}) ? 1 : 0;
        else // faces
            for (std::size_t k = 0; k + 2 < ids.size(); k += 3)
            {
                const std::array<idx, 3> face{ids[k], ids[k + 1], ids[k + 2]};
                const std::size_t edges = inner.split_edges(face, [](idx, idx) { return true; });
                count += edges > 0 || inner.split({face.begin(), face.end()}) ? 1 : 0;
            }
        return count > 0;
    }
    case infeasibility_kind::outside_boundary:
    case infeasibility_kind::not_globally_injective:
        break;
    }
    return false;
}

/// Finds splits that invalidate these proofs: inner edges between fixed vertices, of the elements that they invert or
/// make flat, of outlines and of crossing pairs; faces where there is no such edge; edges from a vertex without a valid
/// position to its fixed neighbours. New vertices are free, so nothing on the boundary is split: a proof from the
/// pinned boundary alone remains, and is the obstacle.
template <class Element>
mending_splits splits_against(const untangle_problem<Element>& problem, const infeasibility& found)
{
    impl::inner_simplices<Element> inner(problem.rest);
    mending_splits result;
    for (const auto& proof : found.proofs)
        if (!impl::split_against(problem, proof, inner) && result.obstacle.empty()) result.obstacle = proof.message;
    result.simplices = inner.take();
    return result;
}

/// Finds splits around elements that stayed inverted: the inner edges between fixed vertices, which as straight edges
/// may leave no room, of all elements that touch these; without any, the longest inner edge of each in the map.
template <class Element>
mending_splits splits_around(const untangle_problem<Element>& problem, std::span<const idx> cells)
{
    const auto at = [](idx i) { return static_cast<std::size_t>(i); };
    const auto& all = problem.rest.cells();
    impl::inner_simplices<Element> inner(problem.rest);
    std::size_t count = 0;
    for (const idx c : cells)
        for (const idx v : all[at(c)])
            for (const idx near : inner.around().row(v))
                count += inner.split_edges(all[at(near)], [&](idx a, idx b)
                                           { return problem.held.any(at(a)) && problem.held.any(at(b)); });
    if (count > 0) return {inner.take(), {}};
    for (const idx c : cells)
    {
        std::vector<std::pair<double, std::vector<idx>>> edges;
        for (const idx a : all[at(c)])
            for (const idx b : all[at(c)])
                if (a < b) edges.push_back({glm::distance(problem.initial[at(a)], problem.initial[at(b)]), {a, b}});
        std::sort(edges.begin(), edges.end());
        while (!edges.empty() && !inner.split(edges.back().second)) edges.pop_back();
    }
    return {inner.take(), {}};
}

} // namespace taut::impl
