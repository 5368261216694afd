// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/impl/core/hierarchy/coarser_volume.hpp>
#include <taut/impl/core/hierarchy/make_volume_hierarchy.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;

/// A cube of tetrahedra of many shapes, without the octant that is nearest to (1, 1, 1): flat sides, creases, a notch.
mesh<tetrahedron> notched_cube(int n)
{
    const auto whole = test::jittered_cube(n, 3);
    std::vector<idx> number(whole.points().size(), -1);
    std::vector<vec3> points;
    std::vector<mesh<tetrahedron>::cell> cells;
    for (auto t : whole.cells())
    {
        vec3 centre(0.0);
        for (const idx v : t) centre += whole.points()[static_cast<std::size_t>(v)] / 4.0;
        if (std::min({centre.x, centre.y, centre.z}) > 0.5) continue;
        for (idx& v : t)
        {
            idx& to = number[static_cast<std::size_t>(v)];
            if (to < 0)
            {
                to = static_cast<idx>(points.size());
                points.push_back(whole.points()[static_cast<std::size_t>(v)]);
            }
            v = to;
        }
        cells.push_back(t);
    }
    return {std::move(points), std::move(cells)};
}

/// What row i of the interpolation makes of the coarse vertices' places, and the sum of its weights.
std::pair<vec3, double> interpolated(const hierarchy<tetrahedron>& h, std::size_t l, std::size_t i,
                                     const mesh<tetrahedron>& m)
{
    vec3 x(0.0);
    double sum = 0;
    const auto& P = h.steps[l].interpolation;
    for (std::size_t k = 0; k < 4; ++k)
    {
        const idx coarse = h.levels[l + 1].vertices.at(static_cast<std::size_t>(P.columns[i][k]));
        x += P.weights[i][k] * m.points()[static_cast<std::size_t>(coarse)];
        sum += P.weights[i][k];
    }
    return {x, sum};
}

double volume_of(const mesh<tetrahedron>& m)
{
    double sum = 0;
    for (idx c = 0; c < m.cell_count(); ++c)
    {
        const auto t = m.rest(c);
        const double det = glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), t[3] - t[0]);
        CHECK(det > 0);
        sum += det / 6;
    }
    return sum;
}

bool same(const hierarchy<tetrahedron>& a, const hierarchy<tetrahedron>& b)
{
    bool all = a.levels.size() == b.levels.size();
    for (std::size_t l = 0; all && l < a.levels.size(); ++l) all = a.levels[l].vertices == b.levels[l].vertices;
    for (std::size_t l = 0; all && l < a.steps.size(); ++l)
        all = a.steps[l].interpolation.columns == b.steps[l].interpolation.columns &&
              a.steps[l].interpolation.weights == b.steps[l].interpolation.weights;
    return all;
}

} // namespace

TEST_CASE("volume hierarchy: levels shrink, and interpolation keeps places, nearly")
{
    for (const auto& m : {test::cube(9), test::jittered_cube(12, 1), notched_cube(10)})
    {
        const auto h = make_hierarchy(m);
        REQUIRE(h.levels.size() >= 3);
        const double edge = std::cbrt(1.0 / static_cast<double>(m.cells().size())); // about
        for (std::size_t l = 0; l < h.steps.size(); ++l)
        {
            CAPTURE(l);
            const auto& fine = h.levels[l].vertices;
            const auto& coarse = h.levels[l + 1].vertices;
            CHECK(coarse.size() * 3 < fine.size());
            CHECK(std::includes(fine.begin(), fine.end(), coarse.begin(), coarse.end()));
            double whole = 0;
            for (std::size_t i = 0; i < fine.size(); ++i)
            {
                const auto [x, sum] = interpolated(h, l, i, m);
                CHECK(std::abs(sum - 1) < 1e-12);
                const double off = glm::length(x - m.points()[static_cast<std::size_t>(fine[i])]);
                whole += off;
                CHECK(off < edge * std::pow(2.0, l)); // what is left is less than an edge
                double size = 0;
                for (const double w : h.steps[l].interpolation.weights[i]) size += std::abs(w);
                CHECK(size < 2 + 1e-12);
            }
            CHECK(whole / static_cast<double>(fine.size()) < 0.2 * edge * std::pow(2.0, l));
        }
        CHECK(h.levels.back().vertices.size() <= 75);
    }
}

TEST_CASE("volume hierarchy: the corners of a cube stay, and its edges are made from its edges")
{
    const auto m = test::cube(8);
    const auto h = make_hierarchy(m);
    const auto rank = [](const vec3& p)
    { return int(p.x == 0 || p.x == 1) + int(p.y == 0 || p.y == 1) + int(p.z == 0 || p.z == 1); };
    for (const auto& level : h.levels)
        CHECK(std::count_if(level.vertices.begin(), level.vertices.end(),
                            [&](idx v) { return rank(m.points()[static_cast<std::size_t>(v)]) == 3; }) == 8);
    const auto& P = h.steps[0].interpolation;
    for (std::size_t i = 0; i < m.points().size(); ++i)
        for (std::size_t k = 0; k < 4; ++k)
            if (std::abs(P.weights[i][k]) > 1e-12)
            {
                const idx from = h.levels[1].vertices[static_cast<std::size_t>(P.columns[i][k])];
                CHECK(rank(m.points()[static_cast<std::size_t>(from)]) >= rank(m.points()[i]));
            }
}

TEST_CASE("volume hierarchy: held vertices are thinned, too, and nothing is interpolated to them")
{
    const auto m = test::jittered_cube(8, 2);
    std::vector<char> held;
    for (const vec3& p : m.points()) held.push_back(p.x == 0 || p.x == 1);
    const auto h = make_hierarchy(m, held);
    REQUIRE(h.levels.size() > 1);
    CHECK(h.levels[1].vertices.size() * 3 < m.points().size());
    for (std::size_t i = 0; i < held.size(); ++i)
    {
        const auto& w = h.steps[0].interpolation.weights[i];
        CHECK(std::all_of(w.begin(), w.end(), [](double x) { return x == 0; }) == (held[i] != 0));
    }
}

TEST_CASE("volume hierarchy: slivers, vertices without cells and meshes of few cells are no trouble")
{
    CHECK(make_hierarchy(test::single_tetrahedron()).levels.size() == 1);
    CHECK(make_hierarchy(test::cube(3)).levels.size() == 1);

    // A plate so thin that all of it lies nearly in a plane, and a vertex on its own.
    const auto cube = test::jittered_cube(8, 4);
    auto points = cube.points();
    for (vec3& p : points) p.z *= 1e-6;
    points.emplace_back(5, 5, 5);
    const mesh<tetrahedron> m(points, cube.cells());
    const auto h = make_hierarchy(m);
    REQUIRE(h.levels.size() >= 3);
    CHECK(std::count(h.levels[1].vertices.begin(), h.levels[1].vertices.end(), m.vertex_count() - 1) == 0);
    for (const auto& row : h.steps[0].interpolation.weights)
        for (const double w : row) CHECK(std::abs(w) <= 2);
}

TEST_CASE("volume hierarchy: neither the number of threads nor size and place of the model change it")
{
    const auto m = test::jittered_cube(22, 5);
    const auto one = make_hierarchy(m, {}, {.threads = 1});
    for (const unsigned threads : {2U, 3U}) CHECK(same(one, make_hierarchy(m, {}, {.threads = threads})));
    for (const double scale : {0x1p-200, 0x1p200})
    {
        auto points = m.points();
        for (vec3& p : points) p *= scale;
        CHECK(same(one, make_hierarchy(mesh<tetrahedron>(points, m.cells()))));
    }
}

TEST_CASE("volume hierarchy: the caller may stop it, and wrong parameters are named")
{
    const auto m = test::cube(9);
    CHECK(make_hierarchy(m, {}, {.proceed = [] { return false; }}).levels.size() == 1);
    CHECK_THROWS_WITH_AS(make_hierarchy(m, std::vector<char>(3)), doctest::Contains("held"), parameter_error);
    CHECK_THROWS_WITH_AS(make_hierarchy(m, {}, {.min_vertices = 1}), doctest::Contains("min_vertices"),
                         parameter_error);
}

TEST_CASE("coarser volume: a valid mesh of fewer vertices that has the same boundary, nearly")
{
    for (const auto& m : {test::cube(12), test::jittered_cube(12, 1), notched_cube(14)})
    {
        std::vector<char> kept;
        for (const vec3& p : m.points()) kept.push_back(p.z == 0);
        for (const auto& held : {std::vector<char>(), kept})
        {
            const auto coarse = make_coarser(m, held);
            const auto &left = coarse.vertices, &into = coarse.into;
            CHECK(check(coarse.volume).empty());
            CHECK(volume_of(coarse.volume) == doctest::Approx(volume_of(m)).epsilon(0.05));
            CHECK(4 * left.size() < m.points().size());
            CHECK(std::is_sorted(left.begin(), left.end()));
            bool same_places = true, near_by = true;
            for (std::size_t k = 0; k < left.size(); ++k)
            {
                const auto v = static_cast<std::size_t>(left[k]);
                same_places &= coarse.volume.points()[k] == m.points()[v] && into[v] == static_cast<idx>(k);
            }
            for (std::size_t v = 0; v < into.size(); ++v)
                near_by &=
                    glm::distance(m.points()[v], coarse.volume.points()[static_cast<std::size_t>(into[v])]) < 0.7;
            CHECK(same_places);
            CHECK(near_by);
            if (!held.empty()) // one layer: each of its vertices has a neighbour that is not held
                CHECK(std::count(kept.begin(), kept.end(), 1) ==
                      std::count_if(left.begin(), left.end(),
                                    [&](idx v) { return kept[static_cast<std::size_t>(v)] != 0; }));
        }
    }
}

TEST_CASE("coarser volume: size and place do not change it, and the caller may stop it")
{
    const auto m = test::jittered_cube(9, 5);
    const auto here = make_coarser(m);
    auto points = m.points();
    for (vec3& p : points) p *= 0x1p-200;
    CHECK(make_coarser(mesh<tetrahedron>(points, m.cells())).vertices == here.vertices);
    CHECK(make_coarser(m, {}, 8, [] { return false; }).volume.cells() == m.cells());
    CHECK_THROWS_WITH_AS(make_coarser(m, std::vector<char>(3)), doctest::Contains("kept"), parameter_error);
    CHECK_THROWS_WITH_AS(make_coarser(m, {}, 1), doctest::Contains("factor"), parameter_error);
}
