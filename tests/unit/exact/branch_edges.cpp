// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/certify.hpp>
#include <taut/impl/core/exact/branch_edges.hpp>
#include <taut/impl/core/measure/describe_defects.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;
using tetrahedra = std::vector<std::array<idx, 4>>;

/// n tetrahedra around the edge from vertex 0 to vertex 1; closed: the last one joins the first.
tetrahedra around_edge(int n, bool closed = true)
{
    tetrahedra cells;
    for (int k = 0; k + (closed ? 0 : 1) < n; ++k) cells.push_back({0, 1, idx(2 + k), idx(2 + (k + 1) % n)});
    return cells;
}

/// Their corners: the rim goes `times` around the edge, which runs along `axis`.
std::vector<vec3> wound(int n, int times, const vec3& axis, double phase)
{
    const vec3 w = glm::normalize(axis);
    const vec3 u = glm::normalize(glm::cross(w, std::abs(w.x) < 0.9 ? vec3(1, 0, 0) : vec3(0, 1, 0)));
    const vec3 v = glm::cross(w, u);
    std::vector<vec3> x{vec3(0.0), w};
    for (int k = 0; k < n; ++k)
    {
        const double angle = phase + 2 * std::numbers::pi * times * k / n;
        x.push_back(0.5 * w + std::cos(angle) * u + std::sin(angle) * v);
    }
    return x;
}

} // namespace

TEST_CASE("branch edges: an edge that tetrahedra go around twice is found, in any direction and from any corner")
{
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    std::vector<vec3> axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 1, 0}, {1, 1, 1}, {1e-9, 0, 1}};
    for (int i = 0; i < 20; ++i) axes.emplace_back(normal(random), normal(random), normal(random));
    for (const vec3& axis : axes)
        for (const int n : {12, 13})
            for (int step = 0; step < 8; ++step)
            {
                auto cells = around_edge(n);
                for (auto& t : cells) // even permutations: the same tetrahedra
                {
                    const auto turn = random() % 3;
                    for (unsigned i = 0; i < turn; ++i) t = {t[0], t[2], t[3], t[1]};
                    if (random() % 2) t = {t[1], t[0], t[3], t[2]};
                }
                for (const int times : {1, 2, 3})
                {
                    const auto x = wound(n, times, axis, step * std::numbers::pi / 4);
                    const auto c = certify<3>(cells, x);
                    REQUIRE(c.flipped == 0);
                    CHECK(c.branched == (times == 1 ? 0 : 1));
                    if (times == 1) continue;
                    CHECK(c.branch_ids == std::vector<idx>{0, 1});
                    CHECK(describe_defects<tetrahedron>(c) == "1 edge (0-1) that tetrahedra go around more than once");
                }
            }
}

TEST_CASE("branch edges: what is no closed ring of positive tetrahedra is not looked at")
{
    const auto x = wound(12, 2, {0, 0, 1}, 0.1);
    CHECK(branch_edges(around_edge(12, false), x).empty()); // the edge lies on the boundary
    auto cells = around_edge(12);
    std::swap(cells[3][2], cells[3][3]);
    CHECK(branch_edges(cells, x).empty()); // one is turned over, and counted as flipped
    CHECK(certify<3>(cells, x).flipped == 1);
    CHECK(branch_edges({}, {}).empty());
}

TEST_CASE("branch edges: volumes at rest have none")
{
    for (const auto& m : {test::cube(6), test::jittered_cube(6, 1), test::single_tetrahedron()})
        CHECK(certify<3>(m.cells(), m.points()));
}
