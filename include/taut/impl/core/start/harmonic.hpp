// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/impl/core/sparse/elimination_solver.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::impl
{

/// Marks the vertices of components with a vertex whose coordinate k is fixed.
template <class Element>
std::vector<char> anchored(const untangle_problem<Element>& problem, const csr& near, int k)
{
    std::vector<char> reached(problem.held.size(), 0);
    std::vector<idx> front;
    for (std::size_t v = 0; v < reached.size(); ++v)
        if (problem.held.test(v, k))
        {
            reached[v] = 1;
            front.push_back(static_cast<idx>(v));
        }
    while (!front.empty())
    {
        const idx v = front.back();
        front.pop_back();
        for (const idx w : near.row(v))
            if (!std::exchange(reached[static_cast<std::size_t>(w)], char{1})) front.push_back(w);
    }
    return reached;
}

/// Computes the harmonic map: every free coordinate is the mean of its neighbours; components without a fixed one are
/// unchanged. With a convex boundary and nothing fixed inside this is Tutte's embedding, which is injective.
/// x: one position per vertex.
template <class Element>
std::vector<vec<Element::dimension>> harmonic_start(const untangle_problem<Element>& problem,
                                                    std::vector<vec<Element::dimension>> x)
{
    const csr near = vertex_neighbours(problem.rest);
    elimination_solver solver;
    for (int k = 0; k < Element::dimension; ++k)
    {
        const std::vector<char> reached = anchored(problem, near, k);
        barycentric_system system;
        std::vector<idx> place(reached.size(), -1);
        for (std::size_t v = 0; v < reached.size(); ++v)
            if (reached[v] && !problem.held.test(v, k))
            {
                place[v] = static_cast<idx>(system.unknown.size());
                system.unknown.push_back(static_cast<idx>(v));
            }
        for (const idx v : system.unknown)
        {
            double excess = 0;
            vec2 rhs(0.0);
            for (const idx w : near.row(v))
            {
                const idx to = place[static_cast<std::size_t>(w)];
                if (to >= 0)
                {
                    system.column.push_back(to);
                    system.weight.push_back(1);
                    continue;
                }
                excess += 1;
                rhs.x += x[static_cast<std::size_t>(w)][k];
            }
            system.offset.push_back(static_cast<idx>(system.column.size()));
            system.excess.push_back(excess);
            system.rhs.push_back(rhs);
        }
        if (system.unknown.empty()) continue;
        const std::vector<vec2> solution = solver(system);
        for (std::size_t i = 0; i < solution.size(); ++i)
            x[static_cast<std::size_t>(system.unknown[i])][k] = solution[i].x;
    }
    return x;
}

} // namespace taut::impl
