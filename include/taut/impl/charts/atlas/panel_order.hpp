// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <taut/impl/core/core/csr.hpp>
#include <taut/impl/core/mesh/order.hpp>

namespace taut::impl
{

/// Breadth-first search from a vertex, level by level, those of a level by their number of neighbours. seen: marks;
/// visited vertices are marked with `mark`, and marked ones are skipped.
inline void append_in_breadth(const csr& near, idx from, std::vector<int>& seen, int mark, std::vector<idx>& order)
{
    const auto u = [](idx v) { return static_cast<std::size_t>(v); };
    const auto degree = [&near](idx v) { return near.row(v).size(); };
    std::size_t head = order.size();
    seen[u(from)] = mark;
    order.push_back(from);
    for (; head < order.size(); ++head)
    {
        const auto first = static_cast<std::ptrdiff_t>(order.size());
        for (const idx w : near.row(order[head]))
            if (seen[u(w)] != mark)
            {
                seen[u(w)] = mark;
                order.push_back(w);
            }
        std::stable_sort(order.begin() + first, order.end(), [&](idx a, idx b) { return degree(a) < degree(b); });
    }
}

/// Bandwidth-reducing order of the vertices (Cuthill, McKee 1969), from an end of each component: the last vertex of a
/// search from the last vertex of a search.
inline std::vector<idx> band_order(const csr& near)
{
    const auto n = static_cast<std::size_t>(near.rows());
    std::vector<idx> order, sweep;
    std::vector<int> seen(n, 0);
    for (std::size_t v = 0; v < n; ++v)
    {
        if (seen[v] != 0) continue;
        idx from = static_cast<idx>(v);
        for (int mark = 1; mark <= 2; ++mark)
        {
            sweep.clear();
            append_in_breadth(near, from, seen, mark, sweep);
            from = sweep.back();
        }
        append_in_breadth(near, from, seen, 3, order);
    }
    return order;
}

/// A band matrix of two unknowns per vertex, stored by panels of two vertices (kernels/charts.cl).
struct panel_profile
{
    permutation order;        ///< vertices in the order of the matrix
    std::vector<idx> heights; ///< rows of each panel, from its own first one; a multiple of 4
    double work = 0;          ///< multiplications of a factorization, about

    /// near: the neighbours of each vertex.
    explicit panel_profile(const csr& near) : order(band_order(near))
    {
        const auto& vertices = order.new_to_old;
        idx reach = 1; // the last vertex of the panel before
        for (std::size_t first = 0; first < vertices.size(); first += 2)
        {
            reach = std::max(reach, static_cast<idx>(first) + 1);
            for (std::size_t i = first; i < std::min(first + 2, vertices.size()); ++i)
                for (const idx w : near.row(vertices[i]))
                    reach = std::max(reach, order.old_to_new[static_cast<std::size_t>(w)]);
            reach |= 1; // whole panels
            const idx height = 2 * (reach - static_cast<idx>(first) + 1);
            heights.push_back(height);
            work += 2.0 * height * height;
        }
    }
};

} // namespace taut::impl
