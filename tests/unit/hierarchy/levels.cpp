// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "support.hpp"
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/impl/core/mesh/order.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;

/// V - E + F.
int euler(const mesh<triangle>& m)
{
    const auto f = facets(m);
    int edges = 0;
    for (std::size_t s = 0; s < f.twin.size(); ++s) edges += f.twin[s] < static_cast<taut::idx>(s) ? 1 : 0;
    return m.vertex_count() - edges + m.cell_count();
}

bool same(const hierarchy<triangle>& a, const hierarchy<triangle>& b)
{
    if (a.levels.size() != b.levels.size()) return false;
    for (std::size_t l = 0; l < a.levels.size(); ++l)
        if (a.levels[l].vertices != b.levels[l].vertices || a.levels[l].cells != b.levels[l].cells) return false;
    for (std::size_t l = 0; l < a.steps.size(); ++l)
    {
        const auto &p = a.steps[l].interpolation, &q = b.steps[l].interpolation;
        if (p.columns != q.columns || p.weights != q.weights || p.transpose.items != q.transpose.items) return false;
        const auto &r = a.steps[l].removed, &s = b.steps[l].removed;
        if (r.vertex != s.vertex || r.target != s.target || r.open != s.open || r.rings.items != s.rings.items ||
            r.rings.offsets != s.rings.offsets || r.rounds != s.rounds)
            return false;
    }
    return true;
}

/// Means of 4 sqrt(3) area / sum of squared edge lengths over the triangles, and the smallest.
std::pair<double, double> quality(const mesh<triangle>& m)
{
    double sum = 0, least = 1;
    for (taut::idx c = 0; c < m.cell_count(); ++c)
    {
        const auto x = m.rest(c);
        double squares = 0;
        for (std::size_t k = 0; k < 3; ++k) squares += std::pow(glm::distance(x[k], x[(k + 1) % 3]), 2);
        const double q = 2 * std::sqrt(3.0) * glm::length(glm::cross(x[1] - x[0], x[2] - x[0])) / squares;
        sum += q;
        least = std::min(least, q);
    }
    return {sum / m.cell_count(), least};
}

} // namespace

TEST_CASE("hierarchy: every level is a valid surface of the same topology")
{
    for (const auto& named : test::thinnable())
    {
        CAPTURE(named.name);
        const auto& m = named.surface;
        const auto h = make_hierarchy(m);
        REQUIRE(h.levels.size() >= 2);
        REQUIRE(h.steps.size() + 1 == h.levels.size());
        CHECK(h.levels[0].cells == m.cells());
        const auto loops = boundary_loops(m).size();
        for (std::size_t l = 0; l < h.levels.size(); ++l)
        {
            CAPTURE(l);
            const auto level = level_mesh(h, l, m.points());
            CHECK(check(level, {.one_boundary = false, .no_handles = false}).empty());
            CHECK(euler(level) == euler(m));
            CHECK(boundary_loops(level).size() == loops);
        }
    }
}

TEST_CASE("hierarchy: levels are nested, with the factor that was asked for, down to the wanted size")
{
    for (const auto& named : test::thinnable())
        for (const double factor : {4.0, 8.0})
        {
            CAPTURE(named.name);
            const auto& m = named.surface;
            CAPTURE(factor);
            const auto h = make_hierarchy(m, {}, {.factor = factor, .min_vertices = 60});
            for (std::size_t l = 0; l + 1 < h.levels.size(); ++l)
            {
                const auto &fine = h.levels[l].vertices, &coarse = h.levels[l + 1].vertices;
                CHECK(std::is_sorted(coarse.begin(), coarse.end()));
                CHECK(std::includes(fine.begin(), fine.end(), coarse.begin(), coarse.end()));
                const double ratio = double(fine.size()) / double(coarse.size());
                CHECK(ratio < 1.01 * factor);
                CHECK(ratio > 1.25);
            }
            CHECK(h.levels.back().vertices.size() >= 60);
            CHECK(h.levels.back().vertices.size() <= 90);
        }
}

TEST_CASE("hierarchy: boundary vertices of a level are boundary vertices of the mesh, and the loops run the same way")
{
    const auto m = test::window_frame(36);
    const auto open = test::on_boundary(m);
    const auto h = make_hierarchy(m);
    const auto fine = boundary_loops(m);
    const auto level = level_mesh(h, h.levels.size() - 1, m.points());
    for (const auto& loop : boundary_loops(level))
    {
        std::vector<taut::idx> ids;
        for (const taut::idx v : loop) ids.push_back(h.levels.back().vertices[static_cast<std::size_t>(v)]);
        for (const taut::idx v : ids) CHECK(open[static_cast<std::size_t>(v)]);
        // In the order of the fine loop, up to where it starts.
        const auto whole = std::find_if(
            fine.begin(), fine.end(), [&](const auto& f) { return std::find(f.begin(), f.end(), ids[0]) != f.end(); });
        REQUIRE(whole != fine.end());
        std::vector<std::ptrdiff_t> at;
        for (const taut::idx v : ids) at.push_back(std::find(whole->begin(), whole->end(), v) - whole->begin());
        std::rotate(at.begin(), std::min_element(at.begin(), at.end()), at.end());
        CHECK(std::is_sorted(at.begin(), at.end()));
    }
}

TEST_CASE("hierarchy: kept vertices are on every level and never the only corners of a new triangle")
{
    for (const auto& named : test::thinnable())
    {
        CAPTURE(named.name);
        const auto& m = named.surface;
        auto keep = test::on_boundary(m); // a fixed boundary and some pins
        for (std::size_t v = 0; v < keep.size(); v += 37) keep[v] = 1;
        const auto h = make_hierarchy(m, keep);
        std::vector<taut::idx> kept;
        for (std::size_t v = 0; v < keep.size(); ++v)
            if (keep[v]) kept.push_back(static_cast<taut::idx>(v));
        const auto locked = [&](const hierarchy<triangle>::level& level)
        {
            int count = 0;
            for (const auto& t : level.cells)
                count +=
                    std::all_of(t.begin(), t.end(),
                                [&](taut::idx v) { return keep[std::size_t(level.vertices[std::size_t(v)])] != 0; });
            return count;
        };
        for (const auto& level : h.levels)
        {
            CHECK(std::includes(level.vertices.begin(), level.vertices.end(), kept.begin(), kept.end()));
            CHECK(locked(level) <= locked(h.levels[0]));
        }
        CHECK(h.levels.size() > 1);
    }
}

TEST_CASE("hierarchy: the number of threads changes nothing")
{
    // Large enough for several threads to be used in the first rounds.
    const auto m = test::bumpy(110, 0.4, 5);
    REQUIRE(m.vertex_count() > 12000);
    const auto one = make_hierarchy(m, {}, {.threads = 1});
    for (const unsigned threads : {2U, 3U, 0U}) CHECK(same(one, make_hierarchy(m, {}, {.threads = threads})));
}

TEST_CASE("hierarchy: size and place of the model do not matter")
{
    const auto m = test::bumpy(30, 0.3, 2);
    const auto original = make_hierarchy(m);
    // Powers of two are exact: the same decisions, but for cubes that leave the range of numbers.
    for (const double scale : {0x1p-100, 0x1p100})
    {
        auto points = m.points();
        for (vec3& p : points) p *= scale;
        CHECK(same(original, make_hierarchy(mesh<triangle>(points, m.cells()))));
    }
}

TEST_CASE("hierarchy: coarse triangles are no worse shaped than fine ones")
{
    for (const auto& named : test::thinnable())
    {
        CAPTURE(named.name);
        const auto& m = named.surface;
        const auto h = make_hierarchy(m);
        const auto fine = quality(m);
        for (std::size_t l = 1; l < h.levels.size(); ++l)
        {
            CAPTURE(l);
            const auto coarse = quality(level_mesh(h, l, m.points()));
            CHECK(coarse.first > std::min(0.6, 0.8 * fine.first));
            CHECK(coarse.second > std::min(0.03, 0.5 * fine.second));
        }
    }
}

TEST_CASE("hierarchy: surfaces that cannot be thinned have one level")
{
    CHECK(make_hierarchy(test::single_triangle()).levels.size() == 1);
    CHECK(make_hierarchy(test::fan(30)).levels.size() == 1);
    CHECK(make_hierarchy(test::grid(4, 4)).levels.size() == 1);
    const auto m = test::grid(20, 20);
    const auto h = make_hierarchy(m, std::vector<char>(m.points().size(), 1)); // nothing may go
    CHECK(h.levels.size() == 1);
    CHECK(h.steps.empty());
}

TEST_CASE("hierarchy: once the caller says no, no further level is made")
{
    const auto m = test::bumpy(30, 0.3, 2);
    CHECK(make_hierarchy(m, {}, {.proceed = [] { return false; }}).levels.size() == 1);
    int asked = 0;
    const auto whole = make_hierarchy(m, {}, {.proceed = [&] { return ++asked > 0; }});
    CHECK(same(whole, make_hierarchy(m)));
    REQUIRE(whole.levels.size() > 1);
    REQUIRE(asked > 2);
    const int all = asked;
    for (const int last : {2, all / 2, all})
    {
        asked = 0;
        const auto part = make_hierarchy(m, {}, {.proceed = [&] { return ++asked < last; }});
        CHECK(asked <= last + 1);
        CHECK(part.levels.size() <= whole.levels.size());
        CHECK(part.steps.size() + 1 == part.levels.size());
        for (std::size_t l = 0; l < part.levels.size(); ++l) CHECK(part.levels[l].cells == whole.levels[l].cells);
    }
}

TEST_CASE("hierarchy: closed surfaces are thinned to the least that there is")
{
    const auto m = test::octahedron();
    const auto h = make_hierarchy(m, {}, {.factor = 2, .min_vertices = 3});
    REQUIRE(h.levels.size() == 2);
    CHECK(h.levels[1].vertices.size() == 4); // a tetrahedron
    CHECK(check(level_mesh(h, 1, m.points()), {.open = false}).empty());

    const auto torus = test::torus(20, false);
    const auto t = make_hierarchy(torus);
    CHECK(t.levels.back().vertices.size() < 80);
    CHECK(euler(level_mesh(t, t.levels.size() - 1, torus.points())) == 0);
}

TEST_CASE("hierarchy: vertices without triangles have no part in it")
{
    const auto m = test::grid(15, 15);
    auto points = m.points();
    points.insert(points.begin(), 3, vec3(9, 9, 9));
    auto cells = m.cells();
    for (auto& t : cells)
        for (taut::idx& v : t) v += 3;
    const auto h = make_hierarchy(mesh<triangle>(points, cells));
    REQUIRE(h.steps.size() == 1);
    CHECK(h.levels[0].vertices.size() == points.size());
    CHECK(h.levels[1].vertices.front() >= 3);
    CHECK(h.steps[0].interpolation.weights[1] == std::array<double, 3>{0, 0, 0});
}

TEST_CASE("hierarchy: bad surfaces and parameters are refused with what is wrong")
{
    const auto fault = [](const mesh<triangle>& m)
    {
        try
        {
            make_hierarchy(m);
        }
        catch (const mesh_error& e)
        {
            return e.ids();
        }
        return std::vector<taut::idx>{-1};
    };
    CHECK(fault(test::bowtie()) == std::vector<taut::idx>{2});
    CHECK(fault(test::three_on_an_edge()) == std::vector<taut::idx>{0, 1});
    CHECK(!fault(test::moebius(9)).empty());
    CHECK(fault(test::moebius(9))[0] >= 0);

    const auto m = test::grid(2, 2);
    CHECK_THROWS_AS(make_hierarchy(m, {}, {.factor = 1.5}), parameter_error);
    CHECK_THROWS_AS(make_hierarchy(m, {}, {.min_vertices = 2}), parameter_error);
    CHECK_THROWS_AS(make_hierarchy(m, std::vector<char>(3, 0)), parameter_error);
}

TEST_CASE("hierarchy: a vertex of very many neighbours is no obstacle")
{
    // The pole of a tube with 300 sides; a hub on the boundary.
    for (const auto& m : {test::tube(300, 0.2), test::fan(300), test::fan(300, true)})
    {
        const auto h = make_hierarchy(m);
        CHECK(h.levels.back().vertices.size() < 100);
        CHECK(check(level_mesh(h, h.levels.size() - 1, m.points())).empty());
    }
}
