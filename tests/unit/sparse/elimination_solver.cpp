// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numeric>

#include <doctest/doctest.h>

#include "support/meshes.hpp"
#include <taut/impl/core/start/barycentric_map.hpp>
#include <taut/impl/core/start/make_barycentric_system.hpp>

namespace
{

using taut::vec2;
using taut::impl::barycentric_system;
using taut::impl::barycentric_weights;

/// A path 0 - 1 - ... - n-1 with fixed ends at x = 0 and x = 1; weight[k] joins k and k + 1, weight[0] the left end.
barycentric_system path(const std::vector<double>& weight)
{
    barycentric_system s;
    const auto n = static_cast<taut::idx>(weight.size()) - 1;
    for (taut::idx i = 0; i < n; ++i)
    {
        const double left = weight[static_cast<std::size_t>(i)];
        const double right = weight[static_cast<std::size_t>(i) + 1];
        if (i > 0)
        {
            s.column.push_back(i - 1);
            s.weight.push_back(left);
        }
        if (i + 1 < n)
        {
            s.column.push_back(i + 1);
            s.weight.push_back(right);
        }
        s.offset.push_back(static_cast<taut::idx>(s.column.size()));
        s.excess.push_back((i == 0 ? left : 0) + (i + 1 == n ? right : 0));
        s.rhs.emplace_back(i + 1 == n ? right : 0, 0);
        s.unknown.push_back(i);
    }
    return s;
}

} // namespace

TEST_CASE("elimination: a path of springs is solved to full relative accuracy whatever their stiffness")
{
    // Position k is the share of compliance to its left. Stiffness over 60 decades: condition number about 1e60.
    std::vector<double> weight;
    for (int k = 0; k < 61; ++k) weight.push_back(std::pow(10.0, (k * 37) % 61 - 30));
    const auto x = taut::impl::elimination_solver{}(path(weight));
    double total = 0;
    for (const double w : weight) total += 1 / w;
    double left = 0;
    for (std::size_t k = 0; k < x.size(); ++k)
    {
        left += 1 / weight[k];
        CHECK(x[k].x == doctest::Approx(left / total).epsilon(1e-13));
        CHECK(x[k].y == 0);
    }
}

TEST_CASE("elimination: one solver takes systems with the same pattern and with others in turn")
{
    taut::impl::elimination_solver solver;
    const auto first = solver(path({1, 1, 1}));
    CHECK(first[0].x == doctest::Approx(1.0 / 3));
    CHECK(solver(path({1, 2, 1}))[0].x == doctest::Approx(0.4));
    CHECK(solver(path({1, 1, 1, 1}))[0].x == doctest::Approx(0.25));
    CHECK(solver(path({1, 1, 1})) == first);
}

TEST_CASE("elimination: ends when it is told to")
{
    taut::impl::elimination_solver solver;
    solver.proceed = [] { return false; };
    CHECK_THROWS_AS(solver(path({1, 1, 1})), taut::impl::elimination_solver::stopped);
    solver.proceed = [] { return true; };
    CHECK(solver(path({1, 1, 1}))[0].x == doctest::Approx(1.0 / 3));
}

TEST_CASE("elimination: no unknowns, no solution")
{
    CHECK(taut::impl::elimination_solver{}(barycentric_system{}).empty());
}

TEST_CASE("elimination: unknowns that hang on nothing are an error")
{
    auto system = path({1, 1, 1});
    for (auto& e : system.excess) e = 0;
    CHECK_THROWS_AS(taut::impl::elimination_solver{}(system), taut::error);
}

TEST_CASE("elimination tree: every variable is eliminated once, children come first, borders are eliminated later")
{
    const auto m = taut::test::bumpy(15, 0.3, 4);
    const std::vector<char> fixed(m.points().size(), 0);
    const std::vector<vec2> x(m.points().size());
    const auto system =
        taut::impl::make_barycentric_system(m.points(), m.cells(), fixed, x, barycentric_weights::uniform);
    const taut::impl::elimination_tree tree(system.offset, system.column);
    std::vector<int> front_of(system.size(), -1);
    int f = 0;
    for (const auto& front : tree.fronts())
    {
        for (const auto child : front.children) CHECK(child < f);
        for (const auto v : front.pivots)
        {
            REQUIRE(front_of[static_cast<std::size_t>(v)] == -1);
            front_of[static_cast<std::size_t>(v)] = f;
        }
        ++f;
    }
    CHECK(std::count(front_of.begin(), front_of.end(), -1) == 0);
    std::size_t fill = 0;
    f = 0;
    for (const auto& front : tree.fronts())
    {
        for (const auto v : front.border) CHECK(front_of[static_cast<std::size_t>(v)] > f);
        // Each neighbour of a pivot is in the front or was eliminated before.
        for (const auto v : front.pivots)
            for (auto k = system.offset[static_cast<std::size_t>(v)];
                 k < system.offset[static_cast<std::size_t>(v) + 1]; ++k)
            {
                const auto j = system.column[static_cast<std::size_t>(k)];
                const bool here = std::count(front.border.begin(), front.border.end(), j) +
                                      std::count(front.pivots.begin(), front.pivots.end(), j) ==
                                  1;
                const bool seen = here || front_of[static_cast<std::size_t>(j)] < f;
                CHECK(seen);
            }
        fill += front.pivots.size() * (front.pivots.size() + front.border.size());
        ++f;
    }
    CHECK(fill < system.size() * 30); // a bad order fills about n^1.5
}

TEST_CASE("barycentric system: rows carry positive weights and the excess towards fixed vertices")
{
    const auto m = taut::test::grid(4, 4);
    const auto loop = taut::boundary_loops(m)[0];
    std::vector<char> fixed(m.points().size(), 0);
    std::vector<vec2> x;
    for (const auto& p : m.points()) x.emplace_back(p.x, p.y);
    for (const auto v : loop) fixed[static_cast<std::size_t>(v)] = 1;
    for (const auto weights : {barycentric_weights::uniform, barycentric_weights::mean_value})
    {
        const auto system = taut::impl::make_barycentric_system(m.points(), m.cells(), fixed, x, weights);
        REQUIRE(system.size() == 9);
        for (std::size_t i = 0; i < 9; ++i)
        {
            const auto v = static_cast<std::size_t>(system.unknown[i]);
            vec2 sum = system.rhs[i];
            double total = system.excess[i];
            for (auto k = system.offset[i]; k < system.offset[i + 1]; ++k)
            {
                const auto e = static_cast<std::size_t>(k);
                CHECK(system.weight[e] > 0);
                sum += system.weight[e] *
                       x[static_cast<std::size_t>(system.unknown[static_cast<std::size_t>(system.column[e])])];
                total += system.weight[e];
            }
            // Both kinds of weights reproduce a regular planar grid.
            CHECK(glm::distance(sum / total, x[v]) < 1e-15);
        }
        CHECK(system.excess[4] == 0); // the centre has no fixed neighbour
    }
}

TEST_CASE("barycentric system: a vertex of a degenerate triangle has uniform weights")
{
    const std::vector<taut::vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}};
    const std::vector<std::array<taut::idx, 3>> cells{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    const std::vector<char> fixed{1, 1, 1, 0};
    const std::vector<vec2> x{{0, 0}, {1, 0}, {0, 1}, {0, 0}};
    for (const auto weights : {barycentric_weights::mean_value, barycentric_weights::uniform})
        CHECK(taut::impl::make_barycentric_system(points, cells, fixed, x, weights).excess[0] == 3);
}
