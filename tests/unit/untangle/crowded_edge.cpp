// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/impl/core/untangle/proofs/crowded_edge.hpp>
#include <taut/impl/core/untangle/untangle_host.hpp>
#include <taut/mesh.hpp>
#include <taut/untangle.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

int sign(const std::vector<vec3>& x, const std::array<taut::idx, 4>& t)
{
    return orient(x[std::size_t(t[0])], x[std::size_t(t[1])], x[std::size_t(t[2])], x[std::size_t(t[3])]).sign;
}

/// Two free vertices, 0 and 1, in a double pyramid over a hexagon 2 ... 7 with the apices 8 and 9. Four corners of the
/// hexagon lie on the floor, seen from above around the edge: `floor` gives their places.
untangle_problem<tetrahedron> edge_over_a_floor(const std::array<vec2, 4>& floor)
{
    std::vector<std::array<taut::idx, 4>> cells;
    std::vector<vec3> rest{{0, 0, -0.3}, {0, 0, 0.3}};
    for (taut::idx k = 0; k < 6; ++k)
    {
        const taut::idx a = 2 + k, b = 2 + (k + 1) % 6;
        cells.push_back({0, 1, a, b});
        cells.push_back({8, 0, a, b});
        cells.push_back({1, 9, a, b});
        rest.emplace_back(std::cos(k * std::acos(-1) / 3), std::sin(k * std::acos(-1) / 3), 0);
    }
    rest.emplace_back(0, 0, -1);
    rest.emplace_back(0, 0, 1);
    auto x = rest;
    const std::array<std::size_t, 4> on_floor{2, 3, 5, 6};
    for (std::size_t k = 0; k < 4; ++k) x[on_floor[k]] = vec3(floor[k], 0);
    x[4] = {4, 0, 3};
    x[7] = {-1, 0, 1};
    x[8] = {1.5, -2, 1};
    x[9] = {1.5, 2, 1};
    x[0] = {1.5, -0.5, 0.5};
    x[1] = {1.5, 0.5, 0.5};
    fixed_marks<3> held(x.size());
    for (std::size_t v = 2; v < x.size(); ++v) held[v] = held.every;
    return {mesh<tetrahedron>(std::move(rest), std::move(cells)), std::move(x), std::move(held)};
}

infeasibility judged(const untangle_problem<tetrahedron>& p)
{
    std::vector<taut::idx> all;
    for (taut::idx c = 0; c < p.rest.cell_count(); ++c) all.push_back(c);
    infeasibility found;
    impl::judge_edges(
        p, all, [] { return true; }, found);
    return found;
}

/// The problem of a mesh whose outline is pinned where it is.
untangle_problem<tetrahedron> within_outline(const mesh<tetrahedron>& m)
{
    fixed_marks<3> held(m.points().size());
    for (const auto& facet : boundary_facets(m))
        for (const taut::idx v : facet) held[std::size_t(v)] = held.every;
    return {m, m.points(), std::move(held)};
}

} // namespace

TEST_CASE("side_view: a form is positive where the tetrahedron is, on all sides")
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> u(0.1, 0.9);
    int counts[3] = {0, 0, 0};
    for (int k = 0; k < 600; ++k)
    {
        const impl::flat_side side{k % 3, k % 2 ? 1.0 : 0.0, k % 2 ? -1 : 1};
        // Vertices 0, 1, 2 within, 3, 4, 5 on the side: multiples of 1/64 between 1/64 and 97/64, so that the view's
        // units are those of the cube.
        std::vector<vec3> x;
        for (int v = 0; v < 6; ++v) x.emplace_back(u(random), u(random), u(random));
        fixed_marks<3> held(6);
        for (std::size_t v = 3; v < 6; ++v)
        {
            for (int i = 0; i < 3; ++i) x[v][i] = v == 3 ? 1 : v == 4 ? 97 : std::round(64 * x[v][i]);
            x[v] /= 64;
            x[v][side.axis] = side.at;
            held[v] = held.every;
        }
        const untangle_problem<tetrahedron> p{mesh<tetrahedron>(x, {{0, 1, 2, 3}}), x, held};
        const std::array<taut::idx, 3> corners{3, 4, 5};
        impl::side_view view(p, side, 0, 1, corners);
        std::array<taut::idx, 6> order{0, 1, 2, 3, 4, 5};
        std::shuffle(order.begin(), order.end(), random);
        const std::array<taut::idx, 4> t{order[0], order[1], order[2], order[3]};
        const auto& form = view.form(t);
        ++counts[form.degree];
        if (form.degree == 0) continue;
        const auto place = [&](std::size_t v)
        {
            const double h = side.inward * (x[v][side.axis] - side.at);
            const auto along = [&](std::size_t w, int i) { return x[w][(side.axis + 1 + i) % 3]; };
            return std::array<double, 3>{(along(v, 0) - along(3, 0)) / h, (along(v, 1) - along(3, 1)) / h, 1 / h};
        };
        std::vector<double> d;
        for (const std::size_t v : {1U, 2U})
            for (std::size_t i = 0; i < 3; ++i) d.push_back(place(v)[i] - place(0)[i]);
        double value = 0;
        if (form.degree == 1)
            for (std::size_t i = 0; i < 6; ++i) value += form.rounded[i] * d[i];
        else
            for (std::size_t i = 0, n = 0; i < 6; ++i)
                for (std::size_t j = i; j < 6; ++j) value += form.rounded[n++] * d[i] * d[j];
        CHECK((value > 0 ? 1 : -1) == sign(x, t));
    }
    CHECK(counts[1] > 100);
    CHECK(counts[2] > 50);
}

TEST_CASE("cases_around: of an edge of four positive tetrahedra one case is true")
{
    std::mt19937 random(2);
    std::normal_distribution<double> u;
    std::array<int, 6> seen{};
    for (int k = 0; k < 20000; ++k)
    {
        std::vector<vec3> x; // the edge's ends 0 and 5, corners 1 to 4
        for (int v = 0; v < 6; ++v) x.emplace_back(u(random), u(random), u(random));
        bool positive = true;
        for (taut::idx c = 1; c <= 4; ++c) positive = positive && sign(x, {0, 5, c, c % 4 + 1}) > 0;
        if (!positive) continue;
        const auto cases = impl::cases_around(0, {1, 2, 3, 4});
        bool any = false;
        for (std::size_t i = 0; i < cases.size(); ++i)
            if (std::all_of(cases[i].begin(), cases[i].end(), [&](const auto& t) { return sign(x, t) > 0; }))
            {
                any = true;
                ++seen[i];
            }
        CHECK(any);
    }
    for (const int n : seen) CHECK(n > 0);
}

TEST_CASE("judge_edges: an edge that two edges of the floor want turned either way has no direction")
{
    // Seen along the line of all four, one pair has the edge's ends in one order, the other in the other one.
    const auto p = edge_over_a_floor({vec2(0, 0), vec2(1, 0), vec2(3, 0), vec2(2, 0)});
    const auto found = judged(p);
    REQUIRE(found);
    CHECK(found.proofs[0].kind == infeasibility_kind::crowded_edge);
    REQUIRE(found.proofs[0].ids.size() >= 4);
    CHECK(found.proofs[0].ids[0] == 0);
    CHECK(found.proofs[0].ids[1] == 1);
    CHECK(found.reason().find("between vertices 0 and 1") != std::string::npos);

    // The way it goes on a hexagon: a positive map exists.
    CHECK(!judged(edge_over_a_floor({vec2(0, 0), vec2(1, 0), vec2(2, 0), vec2(3, 0)})));
}

TEST_CASE("judge_edges: what has a map is never disproved")
{
    for (unsigned seed = 1; seed <= 4; ++seed) CHECK(!judged(within_outline(test::jittered_cube(3, seed))));
    // Sheared and stretched, so that edges lean.
    std::mt19937 random(3);
    std::uniform_real_distribution<double> u(-0.25, 0.25);
    for (int k = 0; k < 6; ++k)
    {
        auto m = test::jittered_cube(3, unsigned(10 + k));
        auto x = m.points();
        for (auto& p : x)
            for (int i = 0; i < 20; ++i)
            {
                const vec3 before = p;
                if (p.x <= 0 || p.x >= 1 || p.y <= 0 || p.y >= 1 || p.z <= 0 || p.z >= 1) break;
                p += vec3(u(random), u(random), u(random));
                const bool kept =
                    std::all_of(m.cells().begin(), m.cells().end(), [&](const auto& t) { return sign(x, t) > 0; });
                if (!kept) p = before;
            }
        CHECK(!judged(within_outline(mesh<tetrahedron>(x, m.cells()))));
    }
}

TEST_CASE("judge_edges: nothing is said where the outline is free, nor after a refusal")
{
    auto p = edge_over_a_floor({vec2(0, 0), vec2(1, 0), vec2(3, 0), vec2(2, 0)});
    infeasibility found;
    const std::array<taut::idx, 1> cell{0};
    impl::judge_edges(
        p, cell, [] { return false; }, found);
    CHECK(!found);
    p.held[9] = 0;
    CHECK(!judged(p));
}

TEST_CASE("untangle: a non_manifold edge is told as the reason why there is no map")
{
    const auto p = edge_over_a_floor({vec2(0, 0), vec2(1, 0), vec2(3, 0), vec2(2, 0)});
    REQUIRE(!find_infeasibility(p));
    const auto r = untangle(p, {.stages = {"harmonic", "proof"}});
    CHECK(r.outcome == outcome::infeasible);
    CHECK(r.reason.find("no direction") != std::string::npos);
    REQUIRE(r.ids.size() >= 2);
    CHECK(r.ids[0] == 0);
    CHECK(r.ids[1] == 1);
}
