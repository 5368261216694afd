// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <taut/types.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::impl
{

/// Untangling problem on a part of a mesh with a fixed rim.
template <class Element>
struct local_problem
{
    untangle_problem<Element> problem;
    std::vector<idx> vertices; ///< in the mesh
};

/// Restricts a problem to the vertices that are `inside`; none where these are more than half of the mesh.
template <class Element>
std::optional<local_problem<Element>> part_of(const untangle_problem<Element>& p, const std::vector<char>& inside)
{
    constexpr int D = Element::dimension;
    const auto at = [](idx v) { return static_cast<std::size_t>(v); };
    std::vector<idx> number(inside.size(), -1);
    std::vector<char> rim(inside.size(), 0);
    std::vector<typename mesh<Element>::cell> cells;
    std::vector<mat<D>> wanted;
    std::vector<idx> owners;
    for (std::size_t c = 0; c < p.rest.cells().size(); ++c)
    {
        const auto& t = p.rest.cells()[c];
        const bool all = std::all_of(t.begin(), t.end(), [&](idx v) { return inside[at(v)] != 0; });
        for (const idx v : t)
            if (all)
                number[at(v)] = 0;
            else
                rim[at(v)] = 1;
        if (!all) continue;
        cells.push_back(t);
        if (!p.wanted.empty()) wanted.push_back(p.wanted[c]);
        if (!p.owners.empty()) owners.push_back(p.owners[c]);
    }
    if (cells.empty() || 2 * cells.size() > p.rest.cells().size()) return std::nullopt;
    std::vector<idx> vertices;
    std::vector<vec3> points;
    std::vector<vec<D>> initial, draft;
    std::vector<std::uint8_t> bits;
    for (std::size_t v = 0; v < number.size(); ++v)
    {
        if (number[v] < 0) continue;
        number[v] = static_cast<idx>(vertices.size());
        vertices.push_back(static_cast<idx>(v));
        points.push_back(p.rest.points()[v]);
        initial.push_back(p.initial[v]);
        if (!p.draft.empty()) draft.push_back(p.draft[v]);
        bits.push_back(rim[v] ? p.held.every : p.held[v]);
    }
    for (auto& t : cells)
        for (idx& v : t) v = number[at(v)];
    return local_problem<Element>{{mesh<Element>(std::move(points), std::move(cells)), std::move(initial),
                                   fixed_marks<D>(std::move(bits)), std::move(draft), std::move(wanted),
                                   std::move(owners)},
                                  std::move(vertices)};
}

} // namespace taut::impl
