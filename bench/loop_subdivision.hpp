// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <taut/impl/core/mesh/facets.hpp>

namespace bench
{

namespace impl
{

/// The weight of each of n neighbours of an interior vertex (Warren's choice; Loop's own differs little).
inline double neighbour_weight(int n)
{
    return n == 3 ? 3.0 / 16 : 3.0 / (8 * n);
}

/// What a vertex knows of its neighbours: sums over all, and over those along the boundary.
struct ring
{
    taut::vec3 sum{0}, rim_sum{0};
    int count = 0, rim_count = 0;

    void add(const taut::vec3& p, bool rim)
    {
        sum += p;
        ++count;
        if (!rim) return;
        rim_sum += p;
        ++rim_count;
    }

    /// A boundary vertex follows the cubic spline of the boundary; one where several boundaries meet stays.
    taut::vec3 moved(const taut::vec3& p) const
    {
        if (rim_count == 2) return 0.75 * p + 0.125 * rim_sum;
        if (rim_count > 0 || count == 0) return p;
        const double w = neighbour_weight(count);
        return (1 - w * count) * p + w * sum;
    }
};

} // namespace impl

/// One round of Loop subdivision: four triangles for each, smooth inside, a cubic spline along the boundary. The old
/// vertices come first. m: an oriented manifold, with or without boundary.
inline taut::mesh<taut::triangle> loop_subdivision(const taut::mesh<taut::triangle>& m)
{
    using taut::idx;
    const auto at = [](idx i) { return static_cast<std::size_t>(i); };
    const auto f = taut::impl::facets(m);
    const auto& old = m.points();
    std::vector<taut::vec3> points(old.size());
    std::vector<impl::ring> rings(old.size());
    std::vector<idx> middle(f.twin.size()); // vertex of each side
    for (std::size_t s = 0; s < f.twin.size(); ++s)
    {
        const bool rim = f.twin[s] < 0;
        if (!rim && at(f.twin[s]) < s)
        {
            middle[s] = middle[at(f.twin[s])];
            continue;
        }
        const auto side = static_cast<idx>(s);
        const auto [a, b] = taut::impl::side_vertices(m, side);
        const taut::vec3 &p = old[at(a)], &q = old[at(b)];
        rings[at(a)].add(q, rim);
        rings[at(b)].add(p, rim);
        const auto across = [&](idx t) { return old[at(m.cells()[at(t / 3)][at(t % 3)])]; };
        middle[s] = static_cast<idx>(points.size());
        points.push_back(rim ? 0.5 * (p + q) : 0.375 * (p + q) + 0.125 * (across(side) + across(f.twin[s])));
    }
    for (std::size_t v = 0; v < old.size(); ++v) points[v] = rings[v].moved(old[v]);

    std::vector<taut::mesh<taut::triangle>::cell> cells;
    cells.reserve(4 * m.cells().size());
    for (std::size_t c = 0; c < m.cells().size(); ++c)
    {
        const auto [i, j, k] = m.cells()[c];
        const idx jk = middle[3 * c], ki = middle[3 * c + 1], ij = middle[3 * c + 2];
        cells.insert(cells.end(), {{i, ij, ki}, {j, jk, ij}, {k, ki, jk}, {ij, jk, ki}});
    }
    return {std::move(points), std::move(cells)};
}

} // namespace bench
