// SPDX-License-Identifier: MIT
#include <atomic>
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/impl/core/start/isometric_newton.hpp>

namespace
{

using taut::vec2;
using block = taut::impl::front_cholesky::block;

/// J^T J with random 6 x 6 entries: positive definite.
std::vector<block> random_blocks(std::size_t count)
{
    std::mt19937 rng(5);
    const auto uniform = [&rng] { return double(rng()) / 4294967296.0 - 0.5; };
    std::vector<block> blocks(count);
    for (block& b : blocks)
    {
        block j;
        for (auto& row : j)
            for (double& value : row) value = uniform();
        for (std::size_t r = 0; r < 6; ++r)
            for (std::size_t c = 0; c < 6; ++c)
            {
                b[r][c] = 0;
                for (std::size_t k = 0; k < 6; ++k) b[r][c] += j[k][r] * j[k][c];
            }
    }
    return blocks;
}

} // namespace

TEST_CASE("front Cholesky: solves sums of triangles' matrices, with and without fixed vertices")
{
    for (const auto& m : {taut::test::single_triangle(), taut::test::fan(6, true), taut::test::grid(12, 9),
                          taut::test::bumpy(20), taut::test::two_components()})
        for (const bool pin : {false, true})
        {
            const std::size_t n = m.points().size();
            std::vector<char> fixed(n, 0);
            if (pin)
                for (std::size_t v = 0; v < n; v += 4) fixed[v] = 1;
            const auto blocks = random_blocks(m.cells().size());
            std::vector<vec2> x(n), b(n, vec2(0.0));
            for (std::size_t v = 0; v < n; ++v)
                if (!fixed[v]) x[v] = {std::sin(double(v)), std::cos(3.0 * double(v))};
            for (std::size_t c = 0; c < blocks.size(); ++c)
                for (std::size_t i = 0; i < 6; ++i)
                    for (std::size_t j = 0; j < 6; ++j)
                        b[std::size_t(m.cells()[c][i / 2])][int(i % 2)] +=
                            blocks[c][i][j] * x[std::size_t(m.cells()[c][j / 2])][int(j % 2)];
            taut::impl::front_cholesky solver(m.cells(), fixed);
            for (int again = 0; again < 2; ++again)
            {
                solver.factorize(blocks, 0);
                const auto y = solver.solve(b);
                for (std::size_t v = 0; v < n; ++v) CHECK(glm::distance(x[v], y[v]) < 1e-7);
            }
        }
}

TEST_CASE("front Cholesky: once the caller says no, there are no factors; the next time there are")
{
    const auto m = taut::test::bumpy(20);
    const std::vector<char> fixed(m.points().size(), 0);
    const auto blocks = random_blocks(m.cells().size());
    taut::impl::front_cholesky solver(m.cells(), fixed), other(m.cells(), fixed);
    int asked = 0;
    CHECK(!solver.factorize(blocks, 0, [&] { return ++asked < 5; }));
    CHECK(asked == 5);
    CHECK(solver.factorize(blocks, 0, [] { return true; }));
    CHECK(other.factorize(blocks, 0));
    const std::vector<vec2> b(m.points().size(), vec2(1.0, -2.0));
    CHECK(solver.solve(b) == other.solve(b));
}

TEST_CASE("front Cholesky: several are factorized together as each is by itself, and which are not definite is told")
{
    using solver = taut::impl::front_cholesky;
    const std::vector<taut::mesh<taut::triangle>> meshes{taut::test::bumpy(40), taut::test::grid(12, 9),
                                                         taut::test::fan(6, true), taut::test::single_triangle()};
    std::vector<std::vector<char>> fixed;
    std::vector<std::vector<block>> blocks;
    for (const auto& m : meshes)
    {
        fixed.emplace_back(m.points().size(), char(0)).front() = 1;
        blocks.push_back(random_blocks(m.cells().size()));
    }
    constexpr std::size_t indefinite = 1;
    for (auto& row : blocks[indefinite].back())
        for (double& value : row) value = -value;

    std::vector<solver> alone, together;
    for (std::size_t i = 0; i < meshes.size(); ++i)
        for (auto* const all : {&alone, &together}) all->emplace_back(meshes[i].cells(), fixed[i]);
    std::vector<solver*> some;
    for (solver& s : together) some.push_back(&s);
    for (const bool definite_only : {true, false})
    {
        std::vector<std::atomic<int>> done(meshes.size());
        solver::factorize_together(
            some, 1e-9, definite_only,
            [&](std::size_t i, std::size_t cell, std::size_t r, std::size_t c) { return blocks[i][cell][r][c]; },
            [&](std::size_t i) { ++done[i]; });
        for (std::size_t i = 0; i < meshes.size(); ++i)
        {
            CHECK(done[i] == 1);
            CHECK(together[i].definite() == (i != indefinite));
            if (definite_only && i == indefinite) continue;
            alone[i].factorize(blocks[i], 1e-9);
            const std::vector<vec2> b(meshes[i].points().size(), vec2(1.0, -2.0));
            CHECK(together[i].solve(b) == alone[i].solve(b));
        }
    }
}

TEST_CASE("isometric Newton: steps go down to a map that no displacement improves, and keep fixed vertices")
{
    const auto m = taut::test::bumpy(10, 0.3);
    const std::size_t n = m.points().size();
    std::vector<vec2> x;
    for (const auto& p : m.points()) x.emplace_back(1.3 * p.x + 0.2 * p.y * p.y, 0.8 * p.y);
    for (const bool pin : {false, true})
    {
        std::vector<char> fixed(n, 0);
        if (pin) fixed[0] = fixed[n / 2] = 1;
        auto uv = x;
        taut::impl::isometric_newton newton(m.points(), m.cells(), fixed);
        double energy = newton.value(uv);
        REQUIRE(std::isfinite(energy));
        for (int i = 0; i < 60; ++i)
        {
            const double before = energy;
            energy = newton.step(uv, energy);
            CHECK(energy <= before);
            CHECK(energy == newton.value(uv));
        }
        CHECK(energy < 4.5);
        if (pin) CHECK((uv[0] == x[0] && uv[n / 2] == x[n / 2]));
        for (std::size_t v = 1; v < n; v += 7)
        {
            if (fixed[v]) continue;
            for (const vec2 d : {vec2(1, 0), vec2(-1, 0), vec2(0, 1), vec2(0, -1)})
            {
                auto moved = uv;
                moved[v] += 1e-4 * d;
                CHECK(newton.value(moved) >= energy * (1 - 1e-12));
            }
        }
    }
}

TEST_CASE("front Cholesky: says whether the sum was positive definite, on meshes of all sizes")
{
    for (const auto& m : {taut::test::single_triangle(), taut::test::grid(12, 9), taut::test::bumpy(40)})
    {
        auto blocks = random_blocks(m.cells().size());
        taut::impl::front_cholesky solver(m.cells(), std::vector<char>(m.points().size(), 0));
        solver.factorize(blocks, 1e-12);
        CHECK(solver.definite());
        for (block& b : blocks)
            for (std::size_t k = 0; k < 6; ++k) b[k][k] -= 5;
        solver.factorize(blocks, 1e-12);
        CHECK_FALSE(solver.definite());
    }
}
