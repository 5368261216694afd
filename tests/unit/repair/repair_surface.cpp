// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <support/extreme_meshes.hpp>
#include <support/meshes.hpp>
#include <taut/impl/charts/repair/repair_surface.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>
#include <taut/repair.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;
using ids = std::vector<idx>;

struct raw_surface
{
    std::vector<vec3> points;
    test::triangles cells;
};

raw_surface raw(const mesh<triangle>& m)
{
    return {m.points(), m.cells()};
}

/// Repairs and checks all that holds for any input: an oriented manifold that maps back.
repaired_surface repair(const raw_surface& input, const repair_params& params = {})
{
    auto r = repair_surface(input.points, input.cells, params);
    const auto& m = r.surface;
    const auto faults = check(m, {.connected = false, .open = false, .one_boundary = false, .no_handles = false});
    if (!faults.empty()) FAIL(faults[0].message);
    REQUIRE(r.vertex_origins.size() == m.points().size());
    REQUIRE(r.cell_origins.size() == m.cells().size());
    REQUIRE(r.turned.size() == m.cells().size());
    CHECK(std::is_sorted(r.vertex_origins.begin(), r.vertex_origins.end()));
    CHECK(std::adjacent_find(r.cell_origins.begin(), r.cell_origins.end(), std::greater_equal<>{}) ==
          r.cell_origins.end());
    bool there = true;
    for (std::size_t c = 0; c < m.cells().size(); ++c)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto v = std::size_t(m.cells()[c][k]);
            const idx corner = input.cells[std::size_t(r.cell_origins[c])][r.corner_origin(c, k)];
            const double off = glm::length(m.points()[v] - input.points[std::size_t(corner)]);
            there = there && off <= 2 * params.weld_tolerance && r.vertex_origins[v] <= corner;
        }
    CHECK(there);
    return r;
}

const repair_finding* find(const std::vector<repair_finding>& findings, repair_kind kind)
{
    const auto at = std::find_if(findings.begin(), findings.end(), [=](const auto& f) { return f.kind == kind; });
    return at == findings.end() ? nullptr : &*at;
}

/// The ids of the only finding, which must be of a kind.
ids only(const repaired_surface& r, repair_kind kind)
{
    for (const auto& f : r.findings)
        if (f.kind != kind) FAIL_CHECK(f.message());
    REQUIRE(r.findings.size() == 1);
    return r.findings[0].ids;
}

/// Every triangle with vertices of its own.
raw_surface apart(const mesh<triangle>& m)
{
    raw_surface r;
    for (const auto& t : m.cells())
    {
        const auto n = static_cast<idx>(r.points.size());
        for (const idx v : t) r.points.push_back(m.points()[std::size_t(v)]);
        r.cells.push_back({n, n + 1, n + 2});
    }
    return r;
}

double volume(const mesh<triangle>& m)
{
    double six = 0;
    for (const auto& t : m.cells())
        six += glm::dot(m.points()[std::size_t(t[0])],
                        glm::cross(m.points()[std::size_t(t[1])], m.points()[std::size_t(t[2])]));
    return six / 6;
}

bool closed(const mesh<triangle>& m)
{
    return boundary_facets(m).empty();
}

std::size_t parts(const mesh<triangle>& m)
{
    return impl::components(m).first.size();
}

void turn(std::array<idx, 3>& t)
{
    std::swap(t[1], t[2]);
}

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

} // namespace

TEST_CASE("repair: nothing of one body is a copy of another one's, or sewn to it")
{
    raw_surface three;
    for (const double shift : {0.0, 0.0, 1.0}) // the second at the place of the first, the third beside it
    {
        const auto first = static_cast<idx>(three.points.size());
        for (const auto& p : {vec3(0, 0, 0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0)})
            three.points.push_back(p + vec3(shift, 0, 0));
        three.cells.push_back({first, first + 1, first + 2});
        three.cells.push_back({first, first + 2, first + 3});
    }
    const auto joined = repair(three);
    CHECK(joined.surface.cell_count() == 4);
    CHECK(joined.surface.vertex_count() == 6);
    const ids apart{0, 0, 0, 0, 7, 7, 7, 7, -1, -1, -1, -1}, pair{0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0};
    for (const double tolerance : {0.0, 1e-3})
    {
        const auto r = repair(three, {.weld_tolerance = tolerance, .bodies = apart});
        CHECK(r.findings.empty());
        CHECK(r.surface.cells() == three.cells);
        CHECK(repair(three, {.weld_tolerance = tolerance, .bodies = pair}).surface.vertex_count() == 10);
    }
    CHECK_THROWS_WITH_AS(repair(three, {.bodies = std::span(pair).first(5)}), doctest::Contains("bodies: 5 for 12"),
                         parameter_error);
}

TEST_CASE("repair: a surface without faults stays as it is")
{
    for (const auto& m : {test::grid(4, 3), test::torus(8, false), test::sphere(2), test::annulus(5)})
    {
        const auto r = repair(raw(m));
        CHECK(r.findings.empty());
        CHECK(r.surface.points() == m.points());
        CHECK(r.surface.cells() == m.cells());
    }
}

TEST_CASE("repair: triangles that name vertices which are not there, or one twice, are left out")
{
    auto s = raw(test::grid(2, 2));
    const auto n = static_cast<idx>(s.points.size());
    s.cells.insert(s.cells.begin(), {{{0, 1, n}}, {{-1, 0, 1}}, {{0, 1, 0}}});
    const auto r = repair(s);
    CHECK(r.surface.cells() == test::grid(2, 2).cells());
    CHECK(r.cell_origins.front() == 3);
    CHECK(find(r.findings, repair_kind::index_out_of_range)->ids == ids{0, 1});
    CHECK(find(r.findings, repair_kind::repeated_vertex)->ids == ids{2});
    CHECK(r.findings.size() == 2);
    CHECK(find(r.findings, repair_kind::repeated_vertex)->message() ==
          "1 triangle (2) naming a vertex twice; left out");
}

TEST_CASE("repair: vertices without a place go with their triangles")
{
    auto s = raw(test::grid(2, 2));
    s.points[8].y = undefined; // a corner of the square
    s.points.push_back({std::numeric_limits<double>::infinity(), 0, 0});
    const auto r = repair(s);
    CHECK(find(r.findings, repair_kind::non_finite)->ids == ids{8, 9});
    CHECK(find(r.findings, repair_kind::unreferenced_vertex)->ids == ids{9});
    for (const auto& t : r.cell_origins)
        for (const idx v : s.cells[std::size_t(t)]) CHECK(v != 8);
    CHECK(r.surface.cell_count() < static_cast<idx>(s.cells.size()));
}

TEST_CASE("repair: vertices that no triangle names are left out, and the others are known by their numbers")
{
    auto s = raw(test::grid(1, 1));
    s.points.insert(s.points.begin() + 1, vec3(7, 7, 7));
    for (auto& t : s.cells)
        for (idx& v : t) v += v > 0 ? 1 : 0;
    const auto r = repair(s);
    CHECK(only(r, repair_kind::unreferenced_vertex) == ids{1});
    CHECK(r.vertex_origins == ids{0, 2, 3, 4});
}

TEST_CASE("repair: flat triangles are left out at any scale, thin ones stay")
{
    for (const double scale : {1e-150, 1e-20, 1.0, 1e150})
    {
        CAPTURE(scale);
        raw_surface s{{{0, 0, 0}, {3, 0, 0}, {1, 0, 0}, {0, 2, 0}, {2, 1e-9, 0}}, {{0, 1, 3}, {0, 2, 1}, {0, 1, 4}}};
        for (vec3& p : s.points) p *= scale;
        const auto r = repair(s);
        CHECK(find(r.findings, repair_kind::degenerate_cell)->ids == ids{1});
        CHECK(r.cell_origins == ids{0, 2});
    }
    // So small beside the others that no area is left of it.
    const auto r = repair({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1e-170, 0, 0}, {0, 1e-170, 0}}, {{0, 1, 2}, {0, 3, 4}}});
    CHECK(only(r, repaired_surface::degenerate_cell) == ids{1});
}

TEST_CASE("repair: a needle between two equal vertices is left out, and what lay beside it is sewn")
{
    auto s = raw(test::sphere(1));
    // Vertex 0 twice: half of its triangles have the copy, and needles lie where they meet the others.
    const auto copy = static_cast<idx>(s.points.size());
    s.points.push_back(s.points[0]);
    int moved = 0;
    for (auto& t : s.cells)
        for (idx& v : t)
            if (v == 0 && s.points[std::size_t(t[1])].x + s.points[std::size_t(t[2])].x > 0 && moved < 2)
            {
                v = copy;
                ++moved;
            }
    const auto needle = static_cast<idx>(s.cells.size());
    s.cells.push_back({0, copy, 6});
    const auto r = repair(s);
    CHECK(closed(r.surface));
    CHECK(find(r.findings, repair_kind::degenerate_cell)->ids == ids{needle});
    CHECK(find(r.findings, repair_kind::coincident_vertex)->ids == ids{0, copy});
    CHECK(r.surface.points() == test::sphere(1).points());
}

TEST_CASE("repair: of copies of a triangle the first stays, whichever way they face")
{
    auto s = raw(test::sphere(1));
    const auto n = static_cast<idx>(s.cells.size());
    s.cells.push_back({s.cells[3][1], s.cells[3][2], s.cells[3][0]});
    s.cells.push_back({s.cells[9][1], s.cells[9][0], s.cells[9][2]});
    s.cells.push_back(s.cells[3]);
    const auto r = repair(s);
    CHECK(only(r, repair_kind::duplicate_cell) == ids{3, n, 3, n + 2, 9, n + 1});
    CHECK(r.surface.cells() == test::sphere(1).cells());
}

namespace
{

/// A sheet and the same turned over, with vertices of its own.
raw_surface with_back(const mesh<triangle>& front)
{
    auto s = raw(front);
    const idx n = front.vertex_count();
    s.points.insert(s.points.end(), front.points().begin(), front.points().end());
    for (const auto& t : front.cells()) s.cells.push_back({t[0] + n, t[2] + n, t[1] + n});
    return s;
}

} // namespace

TEST_CASE("repair: a sheet and its back with vertices of its own both stay, and close")
{
    const auto front = test::flat_disk(3);
    auto s = with_back(front);
    const auto r = repair(s);
    CHECK(closed(r.surface));
    CHECK(only(r, repair_kind::coincident_vertex).size() == 2 * 18); // around the rim
    CHECK(r.surface.vertex_count() == 2 * front.vertex_count() - 18);
    // The same sheet twice, both facing alike, is a copy.
    for (std::size_t c = front.cells().size(); c < s.cells.size(); ++c) turn(s.cells[c]);
    CHECK(repair(s).surface.points() == front.points());
}

TEST_CASE("repair: sewing leaves open what would give two triangles the same vertices")
{
    const auto single = repair(with_back(test::single_triangle()));
    CHECK(single.findings.empty());
    CHECK(single.surface.vertex_count() == 6);
    const auto front = test::grid(3, 3); // some of its corners are triangles with two open edges
    const auto r = repair(with_back(front));
    CHECK(r.surface.cell_count() == 2 * front.cell_count());
    CHECK(parts(r.surface) == 1);
    only(r, repair_kind::coincident_vertex);
}

TEST_CASE("repair: triangles with vertices of their own are sewn to the surface they were")
{
    for (const auto& m : {test::sphere(3), test::torus(12, false), test::bumpy(20)})
    {
        const auto r = repair(apart(m));
        CHECK(r.surface.cell_count() == m.cell_count());
        CHECK(r.surface.vertex_count() == m.vertex_count());
        CHECK(boundary_facets(r.surface).size() == boundary_facets(m).size());
        only(r, repair_kind::coincident_vertex);
        for (const char turned : r.turned) REQUIRE(turned == 0);
    }
}

TEST_CASE("repair: vertices at one place that touch there alone stay apart")
{
    const auto r = repair(apart(test::bowtie()));
    CHECK(r.findings.empty());
    CHECK(r.surface.vertex_count() == 6);
}

TEST_CASE("repair: open edges that meet nearly are sewn within a tolerance, and no vertex moves further")
{
    const auto m = test::sphere(3);
    auto s = apart(m);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> jitter(-1e-6, 1e-6);
    for (vec3& p : s.points) p += vec3(jitter(random), jitter(random), jitter(random));
    CHECK(repair(s).surface.vertex_count() == static_cast<idx>(s.points.size()));
    const auto r = repair(s, {.weld_tolerance = 1e-5});
    CHECK(closed(r.surface));
    CHECK(r.surface.vertex_count() == m.vertex_count());
    for (const double bad : {-1.0, undefined})
        CHECK_THROWS_AS(repair_surface(s.points, s.cells, {.weld_tolerance = bad}), parameter_error);
}

/// Coordinates with so many significant digits, of which the last is off by up to `off`.
double in_digits(double x, int digits, std::mt19937& random, int off)
{
    if (x == 0) return 0;
    const double unit = std::pow(10.0, std::floor(std::log10(std::abs(x))) + 1 - digits);
    return std::round(x / unit + std::uniform_int_distribution<int>(-off, off)(random)) * unit;
}

TEST_CASE(
    "repair: the usual tolerance joins what the last digit parts, in few digits, far away and in single precision")
{
    std::mt19937 random(3);
    const auto m = test::sphere(3);
    for (const vec3 centre : {vec3(0), vec3(337), vec3(455000, 4123000, 20)})
        for (int digits = 6; digits <= 10; ++digits)
        {
            if (centre.y > 1e6 && digits < 9) continue; // a digit is as long as an edge
            auto s = apart(m);
            for (vec3& p : s.points)
                for (int k = 0; k < 3; ++k) p[k] = in_digits(50 * p[k] + centre[k], digits, random, 1);
            const auto r = repair(s, {.weld_tolerance = repair_params::usual_tolerance(s.points, s.cells)});
            INFO(digits, " digits at ", centre.x);
            CHECK(closed(r.surface));
            CHECK(r.surface.vertex_count() == m.vertex_count());
            CHECK(count_near_edges(s.points, s.cells, repair_params::usual_tolerance(s.points, s.cells)) ==
                  s.points.size());
        }
    // Round numbers of one axis, as of an extrusion, are no digits of the others.
    for (int axis = 0; axis < 3; ++axis)
    {
        auto extruded = raw(m);
        for (vec3& p : extruded.points)
        {
            for (int k = 0; k < 3; ++k) p[k] = std::sin(700 * p[k] + k);
            p[axis] = p[axis] > 0 ? 1000 : 999;
        }
        const double usual = repair_params::usual_tolerance(extruded.points, extruded.cells);
        CHECK(usual < 1e-6);
        CHECK(usual > 0);
    }
    auto s = apart(m);
    for (vec3& p : s.points)
        for (int k = 0; k < 3; ++k)
            p[k] = static_cast<double>(std::nextafter(static_cast<float>(p[k] + 5), random() % 2 ? 0.0f : 9.0f));
    CHECK(closed(repair(s, {.weld_tolerance = repair_params::usual_tolerance(s.points, s.cells)}).surface));
    CHECK(repair_params::usual_tolerance(raw(m).points, raw(m).cells) ==
          doctest::Approx(2e-7 * std::sqrt(3.0)).epsilon(0.2));
    CHECK(count_near_edges(m.points(), m.cells(), 1e-3) == 0);
    CHECK(repair_params::usual_tolerance({}, {}) == 0);
    for (const double scale : {1e-200, 1e200, 1e308})
    {
        auto scaled = raw(m);
        for (vec3& p : scaled.points) p *= scale;
        CHECK(repair_params::usual_tolerance(scaled.points, scaled.cells) > 0);
        CHECK(repair_params::usual_tolerance(scaled.points, scaled.cells) < 1e-3 * scale);
    }
}

TEST_CASE("repair: no tolerance makes an edge vanish, and a row of near points does not become one")
{
    raw_surface s;
    const int n = 200;
    for (int i = 0; i < n; ++i) // triangles in a row that nearly touch
    {
        const auto first = static_cast<idx>(s.points.size());
        s.points.insert(s.points.end(), {vec3(i, 1e-4, 0), vec3(i + 1 - 1e-4, 0, 0), vec3(i + 0.5, 1, 0)});
        s.cells.push_back({first, first + 1, first + 2});
    }
    for (const double tolerance : {0.1, 1.0, 10.0, 1e300})
    {
        const auto r = repair_surface(s.points, s.cells, {.weld_tolerance = tolerance});
        CHECK(r.surface.cell_count() == n);
    }
    const auto m = test::sphere(3);
    for (const double tolerance : {1e-2, 1.0, 1e3})
        CHECK(repair(apart(m), {.weld_tolerance = tolerance}).surface.cell_count() == m.cell_count());
}

TEST_CASE("repair: many small triangles within one tolerance take no time with the square of their number")
{
    raw_surface s;
    const int n = 60000;
    for (int i = 0; i < n; ++i)
    {
        const auto first = static_cast<idx>(s.points.size());
        const vec3 at(1e-5 * (i % 300), 1e-5 * (i / 300), 0);
        s.points.insert(s.points.end(), {at, at + vec3(4e-6, 0, 0), at + vec3(0, 4e-6, 0)});
        s.cells.push_back({first, first + 1, first + 2});
    }
    s.points.insert(s.points.end(), {vec3(0, 0, 9), vec3(9, 0, 9), vec3(0, 9, 9)});
    s.cells.push_back({3 * n, 3 * n + 1, 3 * n + 2});
    CHECK(repair_surface(s.points, s.cells, {.weld_tolerance = 1}).surface.cell_count() == n + 1);
}

TEST_CASE("repair: a tolerance leaves vertices alone that lie on no open edge")
{
    const auto m = test::sphere(3);
    CHECK(repair(raw(m), {.weld_tolerance = 0.5}).findings.empty());
}

TEST_CASE("repair: triangles turned over are turned back, the larger part of an open one stays")
{
    auto s = raw(test::grid(6, 6));
    ids few;
    for (idx c = 0; c < static_cast<idx>(s.cells.size()); c += 5)
    {
        turn(s.cells[std::size_t(c)]);
        few.push_back(c);
    }
    const auto r = repair(s);
    CHECK(only(r, repair_kind::inconsistent_orientation) == few);
    auto same = r.surface.cells();
    for (auto& t : same) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    auto wanted = test::grid(6, 6).cells();
    for (auto& t : wanted) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    CHECK(same == wanted);
}

TEST_CASE("repair: a closed part that contradicts itself ends outward, one that does not stays")
{
    auto s = raw(test::sphere(2));
    const double outward = volume(test::sphere(2));
    for (auto& t : s.cells) turn(t);
    CHECK(volume(repair(s).surface) == doctest::Approx(-outward));
    turn(s.cells[17]); // the only one that faces outward
    CHECK(volume(repair(s).surface) == doctest::Approx(outward));
    const auto far = vec3(1e6, 0, 0); // wherever it lies
    for (vec3& p : s.points) p += far;
    CHECK(only(repair(s), repair_kind::inconsistent_orientation).size() == s.cells.size() - 1);
}

TEST_CASE("repair: a one-sided strip is cut open across, once")
{
    for (const int n : {5, 24, 101})
    {
        const auto r = repair(raw(test::moebius(n)));
        CHECK(find(r.findings, repair_kind::not_orientable)->ids.size() == 2); // one edge
        CHECK(repair(raw(r.surface)).findings.empty());                        // and the cut is a boundary like any
        CHECK(parts(r.surface) == 1);
        CHECK(check(r.surface).empty()); // a disk
    }
}

TEST_CASE("repair: the flattest two of three triangles on an edge stay together")
{
    const auto m = test::three_on_an_edge();
    const auto r = repair(raw(m));
    CHECK(only(r, repair_kind::non_manifold_facet) == ids{0, 1});
    CHECK(parts(r.surface) == 2);
    CHECK(r.vertex_origins == ids{0, 0, 1, 1, 2, 3, 4});
    CHECK(r.surface.cells()[0][0] == r.surface.cells()[1][1]); // 0 and 1 lie in a plane
}

TEST_CASE("repair: bodies that touch along an edge or in a vertex part, whole")
{
    const mesh<triangle> cube({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}},
                              {{0, 2, 1},
                               {1, 2, 3},
                               {4, 5, 6},
                               {5, 7, 6},
                               {0, 1, 4},
                               {1, 5, 4},
                               {2, 6, 3},
                               {3, 6, 7},
                               {0, 4, 2},
                               {2, 4, 6},
                               {1, 3, 5},
                               {3, 7, 5}});
    for (const bool edge : {true, false})
    {
        auto s = raw(cube);
        const vec3 shift(1, 1, edge ? 0 : 1);
        std::map<std::array<double, 3>, idx> at;
        for (std::size_t v = 0; v < cube.points().size(); ++v)
        {
            const vec3 p = cube.points()[v];
            at[{p.x, p.y, p.z}] = static_cast<idx>(v);
        }
        ids other;
        for (const vec3& p : cube.points())
        {
            const vec3 q = p + shift;
            const auto [found, fresh] = at.try_emplace({q.x, q.y, q.z}, static_cast<idx>(s.points.size()));
            if (fresh) s.points.push_back(q);
            other.push_back(found->second);
        }
        for (const auto& t : cube.cells())
            s.cells.push_back({other[std::size_t(t[0])], other[std::size_t(t[1])], other[std::size_t(t[2])]});
        const auto r = repair(s);
        CHECK(only(r, edge ? repair_kind::non_manifold_facet : repair_kind::non_manifold_vertex).size() > 0);
        CHECK(parts(r.surface) == 2);
        CHECK(closed(r.surface));
        CHECK(r.surface.vertex_count() == 2 * cube.vertex_count());
    }
}

TEST_CASE("repair: a surface that touches itself along an edge, and hangs together around both its ends, is parted")
{
    const auto m = test::torus(6, false);
    for (std::size_t k = 0; k < 30; ++k)
    {
        // The ends of one edge become those of another: four triangles on an edge of one part.
        auto s = raw(m);
        const auto &from = m.cells()[(7 * k + 31) % m.cells().size()], &to = m.cells()[k];
        for (auto& t : s.cells)
            for (idx& v : t) v = v == from[0] ? to[1] : v == from[1] ? to[0] : v;
        const auto r = repair(s);
        CHECK(find(r.findings, repair_kind::non_manifold_facet) != nullptr);
    }
}

TEST_CASE("repair: where three open edges are at one place, two are sewn, and that one is open is said")
{
    const auto r = repair(apart(test::three_on_an_edge()));
    const ids pairs = only(r, repair_kind::coincident_vertex);
    CHECK(pairs.size() == 4);
    CHECK(r.findings[0].action == "welded; 1 edge left open where three or more triangles would meet");
    CHECK(r.surface.vertex_count() == 7);
}

TEST_CASE("repair: a book of triangles falls apart into pages")
{
    raw_surface s{{{0, 0, 0}, {0, 0, 1}}, {}};
    constexpr int pages = 500;
    for (int i = 0; i < pages; ++i)
    {
        s.points.push_back({std::cos(0.01 * i), std::sin(0.01 * i), 0});
        s.cells.push_back({0, 1, 2 + i});
    }
    const auto r = repair(s);
    CHECK(parts(r.surface) == pages);
    CHECK(only(r, repair_kind::non_manifold_facet) == ids{0, 1});
}

TEST_CASE("repair: normals that all oppose a triangle are named, and change nothing")
{
    const auto m = test::sphere(2);
    auto normals = m.points();
    CHECK(repair(raw(m), {.normals = normals}).findings.empty());
    for (const idx v : m.cells()[5]) normals[std::size_t(v)] *= -1.0;
    const auto r = repair(raw(m), {.normals = normals});
    CHECK(only(r, repair_kind::contradicting_normal) == ids{5});
    CHECK(r.surface.cells() == m.cells());
    // By corners: all of one triangle, and two of another, which also has one without.
    test::triangles corners(m.cells().size(), {0, 0, 0});
    std::vector<vec3> two{vec3(0), -m.points()[std::size_t(m.cells()[7][0])]};
    corners[7] = {1, 1, 1};
    CHECK(only(repair(raw(m), {.normals = two, .normal_cells = corners}), repair_kind::contradicting_normal) == ids{7});
    corners[7] = {1, -1, 1};
    CHECK(repair(raw(m), {.normals = two, .normal_cells = corners}).findings.empty());
    corners[7] = {1, 2, 1};
    CHECK_THROWS_AS(repair_surface(m.points(), m.cells(), {.normals = two, .normal_cells = corners}), parameter_error);
    normals.assign(normals.size(), vec3(undefined));
    CHECK(repair(raw(m), {.normals = normals}).findings.empty());
    normals.pop_back();
    CHECK_THROWS_AS(repair_surface(m.points(), m.cells(), {.normals = normals}), parameter_error);
}

TEST_CASE("repair: nothing that could be mended is an error which says why")
{
    const std::vector<vec3> points{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {undefined, 0, 0}};
    const test::triangles cells{{0, 1, 2}, {0, 1, 3}, {0, 1, 1}, {0, 1, 9}};
    try
    {
        repair_surface(points, cells);
        FAIL("no error");
    }
    catch (const repair_error& e)
    {
        CHECK(e.findings().size() == 4);
        CHECK(std::string(e.what()).find("1 triangle (0) flat at rest") != std::string::npos);
    }
    CHECK_THROWS_AS(repair_surface(points, {}), mesh_error);
}

namespace
{

/// Everything at once: triangles go, come twice, turn, get vertices of their own or of others, and lose coordinates.
raw_surface damaged(const mesh<triangle>& m, std::uint32_t seed, double share)
{
    std::mt19937 random(seed);
    const auto chance = [&](double p) { return std::generate_canonical<double, 32>(random) < p; };
    const auto any = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    raw_surface s{m.points(), {}};
    for (auto t : m.cells())
    {
        if (chance(share)) continue;
        if (chance(share)) turn(t);
        if (chance(share)) s.cells.push_back(s.cells.empty() ? t : s.cells[any(s.cells.size())]);
        for (idx& v : t)
        {
            if (chance(share)) // a vertex of its own
            {
                s.points.push_back(s.points[std::size_t(v)]);
                v = static_cast<idx>(s.points.size()) - 1;
            }
            if (chance(share / 4)) v = static_cast<idx>(any(s.points.size())); // some other one
            if (chance(share / 16)) v = static_cast<idx>(random()) / 2;
        }
        s.cells.push_back(t);
        if (chance(share)) s.cells.push_back({t[0], t[1], static_cast<idx>(any(m.points().size()))}); // a fin
    }
    for (vec3& p : s.points)
        if (chance(share / 32)) p[static_cast<int>(any(3))] = undefined;
    for (double n = share * double(m.points().size()); n > 1; n -= 1) // two vertices become one
    {
        const auto a = static_cast<idx>(any(m.points().size())), b = static_cast<idx>(any(m.points().size()));
        for (auto& t : s.cells)
            for (idx& v : t) v = v == a ? b : v;
    }
    return s;
}

} // namespace

TEST_CASE("repair: closed surfaces damaged at random end as manifolds that map back")
{
    for (std::uint32_t seed = 0; seed < 200; ++seed)
    {
        CAPTURE(seed);
        const auto m = seed % 2 == 0 ? test::sphere(2) : test::torus(8, false);
        const auto s = damaged(m, seed, std::array{0.01, 0.05, 0.2, 0.5}[seed % 4]);
        const auto r = repair(s);
        if (seed % 4 > 1) continue; // where all meets all, another look may sew what the first left open
        for (const auto& f : repair(raw(r.surface)).findings) FAIL_CHECK(f.message());
    }
}

TEST_CASE("repair: small damage costs few triangles, and the rest hangs together")
{
    const auto m = test::sphere(4);
    const auto r = repair(damaged(m, 7, 0.002));
    CHECK(r.surface.cell_count() > m.cell_count() * 98 / 100);
    std::vector<idx> size(std::size_t(r.surface.vertex_count()), 0);
    disjoint_sets sets(r.surface.vertex_count());
    for (const auto& t : r.surface.cells()) sets.join(t[0], t[1]), sets.join(t[0], t[2]);
    for (const auto& t : r.surface.cells()) ++size[std::size_t(sets.find(t[0]))];
    CHECK(*std::max_element(size.begin(), size.end()) > m.cell_count() * 95 / 100);
}

TEST_CASE("repair: a large mesh of loose triangles ends the same every time, sewn")
{
    const auto m = test::sphere(6);
    auto s = apart(m);
    for (std::size_t c = 0; c < s.cells.size(); c += 3) turn(s.cells[c]);
    std::mt19937 random(3);
    std::shuffle(s.cells.begin(), s.cells.end(), random);
    const auto r = repair(s), again = repair(s);
    CHECK(closed(r.surface));
    CHECK(parts(r.surface) == 1);
    CHECK(volume(r.surface) == doctest::Approx(volume(m)));
    CHECK(r.surface.points() == again.surface.points());
    CHECK(r.surface.cells() == again.surface.cells());
    CHECK(r.vertex_origins == again.vertex_origins);
    CHECK(r.turned == again.turned);
}
