// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/core/untangle/proofs/infeasibility.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::impl
{

/// True if fixed coordinates make an element flat for any values of its free coordinates: all corners share a fixed
/// coordinate, two pinned corners coincide, or three pinned corners of a tetrahedron lie on a line.
template <class Element>
bool held_flat(const untangle_problem<Element>& p, const typename mesh<Element>::cell& cell)
{
    constexpr int D = Element::dimension;
    const auto x = [&](idx v) -> const vec<D>& { return p.initial[static_cast<std::size_t>(v)]; };
    const auto pinned = [&](idx v) { return p.held.all(static_cast<std::size_t>(v)); };
    for (int k = 0; k < D; ++k)
        if (std::all_of(cell.begin(), cell.end(),
                        [&](idx v) { return p.held.test(static_cast<std::size_t>(v), k) && x(v)[k] == x(cell[0])[k]; }))
            return true;
    for (std::size_t i = 0; i < cell.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (pinned(cell[i]) && pinned(cell[j]) && x(cell[i]) == x(cell[j])) return true;
    if constexpr (D == 3)
        for (const auto& facet : Element::facets)
        {
            const std::array<idx, 3> v{cell[std::size_t(facet[0])], cell[std::size_t(facet[1])],
                                       cell[std::size_t(facet[2])]};
            if (!std::all_of(v.begin(), v.end(), pinned)) continue;
            bool line = true;
            for (int k = 0; k < 3; ++k)
            {
                const auto shadow = [&](idx i) { return vec2(x(i)[(k + 1) % 3], x(i)[(k + 2) % 3]); };
                line = line && orient2d(shadow(v[0]), shadow(v[1]), shadow(v[2])) == 0;
            }
            if (line) return true;
        }
    return false;
}

/// Elements that no position of the free vertices makes positive.
template <class Element>
void judge_elements(const untangle_problem<Element>& p, infeasibility& found)
{
    std::vector<idx> inverted, flat;
    for (idx c = 0; c < p.rest.cell_count(); ++c)
    {
        const auto& cell = p.rest.cells()[static_cast<std::size_t>(c)];
        std::size_t pinned = 0;
        for (const idx v : cell) pinned += p.held.all(static_cast<std::size_t>(v)) ? 1 : 0;
        if (pinned < cell.size())
        {
            if (held_flat(p, cell)) flat.push_back(c);
            continue;
        }
        const auto sign = [&]<std::size_t... K>(std::index_sequence<K...>)
        {
            return orient(p.initial[static_cast<std::size_t>(cell[K])]...).sign;
        };
        if (sign(std::make_index_sequence<Element::corners>{}) <= 0) inverted.push_back(c);
    }
    const auto cells = [&](const std::vector<idx>& ids)
    { return list_first_elements<Element>(ids.size(), ids, p.owners); };
    found.prove(infeasibility_kind::inverted_element, std::move(inverted),
                [&](const auto& ids)
                { return cells(ids) + " with all vertices pinned, flipped or flat; move or free a vertex of each"; });
    found.prove(infeasibility_kind::flat_element, std::move(flat),
                [&](const auto& ids)
                {
                    return cells(ids) +
                           " that fixed coordinates make flat wherever the others go; move or free a vertex "
                           "of each";
                });
}

} // namespace taut::impl
