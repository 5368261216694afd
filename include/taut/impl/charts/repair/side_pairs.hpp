// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/impl/charts/repair/winding.hpp>

/// Pairing of the sides of triangles that share an edge of the surface.
namespace taut::impl
{

struct side_pairs
{
    std::vector<idx> twin; ///< one per side; -1: open

    void join(idx s, idx t)
    {
        twin[static_cast<std::size_t>(s)] = t;
        twin[static_cast<std::size_t>(t)] = s;
    }
    void part(idx s)
    {
        idx& other = twin[static_cast<std::size_t>(s)];
        if (other >= 0) twin[static_cast<std::size_t>(other)] = -1;
        other = -1;
    }
};

/// Pairs the sides at a place if there are two, and those of an edge of the input if there are two. What is left where
/// two or more are: `open`, one list for each of f.crowds.
inline side_pairs pair_clear_sides(const placed_triangles& t, const facet_table& f, std::vector<std::vector<idx>>& open)
{
    side_pairs pairs{f.twin};
    for (idx& s : pairs.twin) s = std::max(s, idx(-1));
    open.assign(f.crowds.size(), {});
    for (std::size_t i = 0; i < open.size(); ++i)
    {
        auto crowd = f.crowds[i];
        std::sort(crowd.begin(), crowd.end(),
                  [&](idx a, idx b) { return std::pair(t.edge(a), a) < std::pair(t.edge(b), b); });
        for (std::size_t k = 0, last = 0; k < crowd.size(); k = last)
        {
            while (last < crowd.size() && t.edge(crowd[last]) == t.edge(crowd[k])) ++last;
            if (last - k == 2)
                pairs.join(crowd[k], crowd[k + 1]);
            else
                open[i].insert(open[i].end(), crowd.begin() + static_cast<std::ptrdiff_t>(k),
                               crowd.begin() + static_cast<std::ptrdiff_t>(last));
        }
    }
    return pairs;
}

/// The direction across the edge of a side in the plane of its triangle, away from the edge.
inline vec3 direction_from_edge(const placed_triangles& t, idx side)
{
    const auto x = t.rest(side / 3);
    const auto k = static_cast<std::size_t>(side % 3);
    const vec3 from = x[(k + 1) % 3], along = glm::normalize(x[(k + 2) % 3] - from), apex = x[k] - from;
    const vec3 across = apex - glm::dot(apex, along) * along;
    const double length = glm::length(across);
    return length > 0 ? across / length : across;
}

/// Pairs the sides of a crowd that run opposite ways once triangles are turned: those of one polygon first, then those
/// of one edge of the input, then those that bend least, then those of one sheet. More than a few are left open, as
/// nothing tells who belongs together.
inline void pair_crowd(const placed_triangles& t, const winding& w, const std::vector<idx>& crowd, side_pairs& pairs)
{
    constexpr std::size_t most = 16;
    if (crowd.size() < 2 || crowd.size() > most) return;
    const auto cell = [](idx side) { return static_cast<std::size_t>(side / 3); };
    std::vector<vec3> away;
    for (const idx s : crowd) away.push_back(direction_from_edge(t, s));
    std::vector<std::tuple<bool, bool, long, bool, idx, idx>> candidates;
    for (std::size_t i = 0; i < crowd.size(); ++i)
        for (std::size_t j = i + 1; j < crowd.size(); ++j)
        {
            const idx a = crowd[i], b = crowd[j];
            if (t.clash(a, b) == (w.turned[cell(a)] == w.turned[cell(b)])) continue;
            // Rounded, so that angles are equal where only their last digits differ.
            const long bend = std::lround(1e6 * glm::dot(away[i], away[j]));
            candidates.emplace_back(!t.together(a, b), t.edge(a) != t.edge(b), bend,
                                    w.sheet[cell(a)] != w.sheet[cell(b)], std::min(a, b), std::max(a, b));
        }
    std::sort(candidates.begin(), candidates.end());
    for (const auto& [polygons, edges, bend, sheets, a, b] : candidates)
        if (pairs.twin[static_cast<std::size_t>(a)] < 0 && pairs.twin[static_cast<std::size_t>(b)] < 0)
            pairs.join(a, b);
}

} // namespace taut::impl
