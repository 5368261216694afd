// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/mesh/manifold.hpp>

namespace taut::impl
{

bool orientable(const facet_table& f, idx corners)
{
    if (f.clash.empty()) return true;
    const auto cells = static_cast<idx>(f.twin.size()) / corners;
    // Node c is "cell c as it is", node cells + c "turned over".
    disjoint_sets sets(2 * cells);
    std::vector<char> clashes(f.twin.size(), 0);
    for (const auto& [a, b] : f.clash) clashes[static_cast<std::size_t>(a)] = clashes[static_cast<std::size_t>(b)] = 1;
    for (std::size_t s = 0; s < f.twin.size(); ++s)
    {
        if (f.twin[s] < static_cast<idx>(s)) continue;
        const idx a = static_cast<idx>(s) / corners, b = f.twin[s] / corners;
        sets.join(a, clashes[s] ? cells + b : b);
        sets.join(cells + a, clashes[s] ? b : cells + b);
    }
    for (idx c = 0; c < cells; ++c)
        if (sets.find(c) == sets.find(cells + c)) return false;
    return true;
}

std::vector<idx> vertices_of_several_fans(const mesh<triangle>& m, const facet_table& f)
{
    std::vector<idx> valence(m.points().size(), 0), last(m.points().size(), 0);
    for (std::size_t c = 0; c < m.cells().size(); ++c)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto v = static_cast<std::size_t>(m.cells()[c][k]);
            ++valence[v];
            last[v] = static_cast<idx>(3 * c + k);
        }
    parallel_for(valence.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t v = begin; v < end; ++v)
                         if (valence[v] > 0) valence[v] -= fan_size(f, last[v]);
                 });
    std::vector<idx> ids;
    for (std::size_t v = 0; v < valence.size(); ++v)
        if (valence[v] > 0) ids.push_back(static_cast<idx>(v));
    return ids;
}

} // namespace taut::impl
