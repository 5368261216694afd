// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <taut/untangle_problem.hpp>

/// Small problems that have no solution on their mesh, but have one where elements are split.
namespace taut::test
{

/// Four tetrahedra around an edge, all six vertices pinned, two of them beyond the edge: the tetrahedron between these
/// is inverted, as the dihedral angle of the boundary there is more than half a turn.
inline untangle_problem<tetrahedron> folded_edge()
{
    const std::vector<vec3> rest{{0, 0, -1}, {0, 0, 1}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}};
    auto x = rest;
    x[2].x = x[3].x = -0.2;
    impl::fixed_marks<3> held(rest.size());
    for (std::size_t v = 0; v < rest.size(); ++v) held[v] = held.every;
    return {mesh<tetrahedron>(rest, {{0, 1, 2, 3}, {0, 1, 3, 4}, {0, 1, 4, 5}, {0, 1, 5, 2}}), std::move(x),
            std::move(held)};
}

/// Two triangles on a diagonal, all four vertices pinned, one of them beyond the diagonal.
inline untangle_problem<triangle> reflex_quad()
{
    impl::fixed_marks<2> held(4);
    for (std::size_t v = 0; v < 4; ++v) held[v] = held.every;
    return {mesh<triangle>({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 3}, {1, 2, 3}}),
            {{0.7, 0.7}, {1, 0}, {1, 1}, {0, 1}},
            std::move(held)};
}

/// A fan of triangles around a free vertex, whose rim is pinned to the outline of a U: no point sees all of it.
inline untangle_problem<triangle> fan_in_a_u()
{
    const std::vector<vec2> outline{{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
    const auto n = static_cast<idx>(outline.size());
    std::vector<vec3> rest;
    for (idx k = 0; k < n; ++k) rest.emplace_back(std::cos(k * 6.283185307 / n), std::sin(k * 6.283185307 / n), 0.0);
    rest.emplace_back(0.0);
    std::vector<mesh<triangle>::cell> cells;
    for (idx k = 0; k < n; ++k) cells.push_back({k, (k + 1) % n, n});
    auto x = outline;
    x.emplace_back(1.5, 0.5);
    impl::fixed_marks<2> held(x.size());
    for (std::size_t v = 0; v < outline.size(); ++v) held[v] = held.every;
    return {mesh<triangle>(std::move(rest), std::move(cells)), std::move(x), std::move(held)};
}

/// The same with height: tetrahedra around a free vertex, their faces opposite it pinned to a prism on a U. No proof
/// finds it, as none knows of stars in space.
inline untangle_problem<tetrahedron> cone_in_a_u()
{
    const auto base = fan_in_a_u();
    const auto n = static_cast<idx>(base.initial.size()) - 1; // of the outline
    std::vector<vec3> rest, x;
    for (const double z : {0.0, 1.0})
        for (idx k = 0; k < n; ++k)
        {
            rest.push_back(base.rest.points()[static_cast<std::size_t>(k)] + vec3(0, 0, z));
            x.emplace_back(base.initial[static_cast<std::size_t>(k)], z);
        }
    rest.emplace_back(0.0, 0.0, 0.5);
    x.emplace_back(1.5, 0.5, 0.5);
    const idx middle = 2 * n;
    std::vector<mesh<tetrahedron>::cell> cells;
    for (const auto& [a, b, c] :
         std::vector<std::array<idx, 3>>{{0, 1, 4}, {0, 4, 5}, {1, 2, 4}, {2, 3, 4}, {0, 5, 7}, {5, 6, 7}})
    {
        cells.push_back({a, b, c, middle});
        cells.push_back({n + a, n + c, n + b, middle});
    }
    for (idx k = 0; k < n; ++k)
    {
        const idx next = (k + 1) % n;
        cells.push_back({k, n + next, next, middle});
        cells.push_back({k, n + k, n + next, middle});
    }
    impl::fixed_marks<3> held(x.size());
    for (std::size_t v = 0; v + 1 < x.size(); ++v) held[v] = held.every;
    return {mesh<tetrahedron>(std::move(rest), std::move(cells)), std::move(x), std::move(held)};
}

} // namespace taut::test
