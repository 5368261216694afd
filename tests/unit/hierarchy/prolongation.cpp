// SPDX-License-Identifier: MIT
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include "support.hpp"

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;

std::vector<vec3> positions(const hierarchy<triangle>& h, std::size_t level, const mesh<triangle>& m)
{
    std::vector<vec3> x;
    for (const taut::idx v : h.levels[level].vertices) x.push_back(m.points()[static_cast<std::size_t>(v)]);
    return x;
}

/// Kept corners of the unit square, and of the window in it.
std::vector<char> corners(const mesh<triangle>& m)
{
    std::vector<char> keep;
    const auto open = test::on_boundary(m);
    for (std::size_t v = 0; v < m.points().size(); ++v)
    {
        const vec3& p = m.points()[v];
        const bool outer = (p.x == 0 || p.x == 1) && (p.y == 0 || p.y == 1);
        const bool inner = open[v] && std::abs(std::abs(p.x - 0.5) - std::abs(p.y - 0.5)) < 1e-9;
        keep.push_back(outer || inner);
    }
    return keep;
}

} // namespace

TEST_CASE("prolongation: rows are barycentric coordinates in a coarse triangle")
{
    for (const auto& named : test::thinnable())
    {
        CAPTURE(named.name);
        const auto& m = named.surface;
        const auto h = make_hierarchy(m);
        for (std::size_t l = 0; l < h.steps.size(); ++l)
        {
            const auto& P = h.steps[l].interpolation;
            const auto coarse_count = static_cast<taut::idx>(h.levels[l + 1].vertices.size());
            REQUIRE(P.rows() == static_cast<taut::idx>(h.levels[l].vertices.size()));
            const auto coarse = level_mesh(h, l + 1, m.points());
            const csr cells = vertex_cells(coarse);
            for (std::size_t i = 0; i < P.columns.size(); ++i)
            {
                double sum = 0;
                for (std::size_t k = 0; k < 3; ++k)
                {
                    REQUIRE(P.columns[i][k] >= 0);
                    REQUIRE(P.columns[i][k] < coarse_count);
                    REQUIRE(P.weights[i][k] >= 0);
                    sum += P.weights[i][k];
                }
                CHECK(std::abs(sum - 1) < 1e-14);
                bool found = false;
                for (const taut::idx c : cells.row(P.columns[i][0]))
                {
                    bool all = true;
                    for (const taut::idx v : P.columns[i])
                    {
                        const auto& t = coarse.cells()[static_cast<std::size_t>(c)];
                        all = all && std::find(t.begin(), t.end(), v) != t.end();
                    }
                    found = found || all;
                }
                CHECK(found);
            }
        }
    }
}

TEST_CASE("prolongation: a vertex that stays has one weight, 1")
{
    const auto m = test::bumpy(40, 0.2, 4);
    const auto h = make_hierarchy(m);
    for (std::size_t l = 0; l < h.steps.size(); ++l)
    {
        const auto &fine = h.levels[l].vertices, &coarse = h.levels[l + 1].vertices;
        for (std::size_t j = 0; j < coarse.size(); ++j)
        {
            const auto i = std::size_t(std::lower_bound(fine.begin(), fine.end(), coarse[j]) - fine.begin());
            CHECK(h.steps[l].interpolation.columns[i][0] == static_cast<taut::idx>(j));
            CHECK(h.steps[l].interpolation.weights[i] == std::array<double, 3>{1, 0, 0});
        }
    }
}

TEST_CASE("prolongation: linear functions of a planar mesh are reproduced, straight boundaries included")
{
    for (const auto& m : {test::grid(40, 40), test::bumpy(40, 0.0, 11), test::window_frame(36)})
    {
        const auto h = make_hierarchy(m, corners(m));
        REQUIRE(h.steps.size() >= 1);
        for (std::size_t l = 0; l < h.steps.size(); ++l)
        {
            const auto coarse = positions(h, l + 1, m), expected = positions(h, l, m);
            std::vector<vec3> fine(expected.size());
            prolong<3, vec3>(h.steps[l].interpolation, coarse, fine);
            double error = 0;
            for (std::size_t i = 0; i < fine.size(); ++i) error = std::max(error, glm::distance(fine[i], expected[i]));
            CHECK(error < 1e-11);
        }
    }
}

TEST_CASE("prolongation: a curved surface is interpolated to the size of its triangles squared")
{
    const auto m = test::cap(60, 1.2); // unit sphere
    const auto h = make_hierarchy(m);
    const auto coarse = positions(h, 1, m), expected = positions(h, 0, m);
    std::vector<vec3> fine(expected.size());
    prolong<3, vec3>(h.steps[0].interpolation, coarse, fine);
    double error = 0;
    for (std::size_t i = 0; i < fine.size(); ++i) error += glm::distance(fine[i], expected[i]) / double(fine.size());
    // Coarse edges are about 0.06 long: sagitta 0.06^2 / 8; distances along the surface shrink as much.
    CHECK(error < 2e-3);
}

TEST_CASE("prolongation: restriction is its transpose")
{
    const auto m = test::tube(30, 4);
    const auto h = make_hierarchy(m);
    const auto& P = h.steps[0].interpolation;
    std::mt19937 rng(1);
    const auto random = [&](std::size_t n)
    {
        std::vector<double> x(n);
        for (double& v : x) v = double(rng()) / 4294967296.0 - 0.5;
        return x;
    };
    const auto coarse = random(h.levels[1].vertices.size()), fine = random(h.levels[0].vertices.size());
    std::vector<double> up(fine.size()), down(coarse.size());
    prolong<3, double>(P, coarse, up);
    for (std::size_t j = 0; j < down.size(); ++j)
        for (const idx place : P.transpose.row(static_cast<idx>(j)))
        {
            const auto row = static_cast<std::size_t>(place / 4), k = static_cast<std::size_t>(place % 4);
            CHECK(P.columns[row][k] == static_cast<idx>(j));
            down[j] += P.weights[row][k] * fine[row];
        }
    double left = 0, right = 0;
    for (std::size_t i = 0; i < fine.size(); ++i) left += up[i] * fine[i];
    for (std::size_t j = 0; j < coarse.size(); ++j) right += down[j] * coarse[j];
    CHECK(left == doctest::Approx(right).epsilon(1e-12));
    CHECK(std::abs(left) > 1e-3);
}
