// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstdint>
#include <random>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/impl/core/mesh/order.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;

/// The mesh with its vertices and cells in random order.
template <class Element>
mesh<Element> shuffled(const mesh<Element>& m)
{
    std::mt19937 rng(9);
    std::vector<taut::idx> v(m.points().size()), c(m.cells().size());
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = static_cast<taut::idx>(i);
    for (std::size_t i = 0; i < c.size(); ++i) c[i] = static_cast<taut::idx>(i);
    std::shuffle(v.begin(), v.end(), rng);
    std::shuffle(c.begin(), c.end(), rng);
    return permute(m, {permutation(v), permutation(c)});
}

/// Mean distance in memory between the vertices of a cell.
template <class Element>
double span(const mesh<Element>& m)
{
    double sum = 0;
    for (const auto& t : m.cells())
        sum += *std::max_element(t.begin(), t.end()) - *std::min_element(t.begin(), t.end());
    return sum / m.cell_count();
}

} // namespace

TEST_CASE("permutation: apply and undo are inverse")
{
    const permutation p({2, 0, 3, 1});
    const std::vector<int> values = {10, 11, 12, 13};
    CHECK(p.apply(values) == std::vector<int>{12, 10, 13, 11});
    CHECK(p.undo(p.apply(values)) == values);
    CHECK(p.old_to_new == std::vector<taut::idx>{1, 3, 0, 2});
}

TEST_CASE_TEMPLATE("order: the mesh stays the same mesh", Element, triangle, tetrahedron)
{
    const auto original = []
    {
        if constexpr (Element::dimension == 2)
            return shuffled(test::bumpy(12));
        else
            return shuffled(test::cube(4));
    }();
    const auto order = locality_order(original);
    const auto m = permute(original, order);
    REQUIRE(m.cell_count() == original.cell_count());
    REQUIRE(m.vertex_count() == original.vertex_count());
    for (taut::idx c = 0; c < m.cell_count(); ++c)
        CHECK(m.rest(c) == original.rest(order.cells.new_to_old[static_cast<std::size_t>(c)]));
    // Undone on output, bit for bit.
    CHECK(order.vertices.undo(m.points()) == original.points());
}

TEST_CASE("order: the Morton code interleaves all 21 bits of the coordinates")
{
    std::mt19937 rng(2);
    for (int trial = 0; trial < 200; ++trial)
    {
        const std::array<std::uint32_t, 3> x = {std::uint32_t(rng() >> 11), std::uint32_t(rng() >> 11),
                                                std::uint32_t(rng() >> 11)};
        std::uint64_t expected = 0;
        for (int b = 20; b >= 0; --b)
            for (const auto c : x) expected = expected << 1 | (c >> b & 1u);
        CHECK(impl::morton(vec3(x[0], x[1], x[2])) == expected);
    }
}

TEST_CASE("order: neighbours come close and cells follow their vertices")
{
    const auto original = shuffled(test::flat_disk(40));
    const auto m = permute(original, locality_order(original));
    CHECK(span(m) < 0.1 * span(original));
    const auto least = [&](taut::idx c)
    {
        const auto& t = m.cells()[static_cast<std::size_t>(c)];
        return *std::min_element(t.begin(), t.end());
    };
    for (taut::idx c = 1; c < m.cell_count(); ++c) CHECK(least(c - 1) <= least(c));

    const auto solid = shuffled(test::cube(8));
    CHECK(span(permute(solid, locality_order(solid))) < 0.4 * span(solid));
}

TEST_CASE("order: depends on the shape alone, and survives points in one place or at any scale")
{
    const auto m = test::bumpy(5);
    const auto expected = locality_order(m).vertices.new_to_old;
    for (const double s : {0x1p-1000, 0x1p1022})
    {
        auto points = m.points();
        for (vec3& p : points) p *= s;
        CHECK(locality_order(mesh<triangle>(points, m.cells())).vertices.new_to_old == expected);
    }
    const mesh<triangle> point(std::vector<vec3>(m.points().size(), vec3(3.0)), m.cells());
    CHECK(locality_order(point).vertices.new_to_old[7] == 7); // ties keep the order of the file
}

TEST_CASE("incidence: the corners of each vertex, sorted, each once")
{
    const auto m = test::bumpy(8);
    const csr r = vertex_corners(m);
    REQUIRE(r.rows() == m.vertex_count());
    CHECK(r.items.size() == 3 * m.cells().size());
    for (taut::idx v = 0; v < r.rows(); ++v)
    {
        CHECK(std::is_sorted(r.row(v).begin(), r.row(v).end()));
        for (const taut::idx i : r.row(v))
            CHECK(m.cells()[static_cast<std::size_t>(i / 3)][static_cast<std::size_t>(i % 3)] == v);
    }
    const csr cells = vertex_cells(m);
    for (std::size_t i = 0; i < r.items.size(); ++i) CHECK(cells.items[i] == r.items[i] / 3);
}

TEST_CASE("incidence: neighbours share a cell; a vertex without a cell has an empty row")
{
    const auto fan = vertex_neighbours(test::fan(3));
    CHECK(std::vector<taut::idx>(fan.row(0).begin(), fan.row(0).end()) == std::vector<taut::idx>{1, 2, 3, 4});
    CHECK(std::vector<taut::idx>(fan.row(1).begin(), fan.row(1).end()) == std::vector<taut::idx>{0, 2});

    auto points = test::single_triangle().points();
    points.push_back(vec3(1.0));
    const auto loose = vertex_neighbours(mesh<triangle>(points, {{0, 1, 2}}));
    REQUIRE(loose.rows() == 4);
    CHECK(loose.row(3).empty());

    const auto tets = vertex_neighbours(test::single_tetrahedron());
    for (taut::idx v = 0; v < 4; ++v) CHECK(tets.row(v).size() == 3);
}

TEST_CASE("order: pinned vertices come last, all else stays in locality order")
{
    const auto m = shuffled(test::bumpy(12));
    std::vector<bool> pinned(m.points().size());
    for (std::size_t v = 0; v < pinned.size(); ++v) pinned[v] = v % 3 == 0;
    const auto all = locality_order(m);
    const solution_order s(m, pinned);
    CHECK(s.free_count == static_cast<taut::idx>(std::count(pinned.begin(), pinned.end(), false)));
    CHECK(s.order.cells.new_to_old == all.cells.new_to_old);
    for (std::size_t i = 0; i < pinned.size(); ++i)
    {
        const auto number = [&](std::size_t at) { return static_cast<std::size_t>(s.order.vertices.new_to_old[at]); };
        CHECK(pinned[number(i)] == (static_cast<taut::idx>(i) >= s.free_count));
        if (i > 0 && pinned[number(i)] == pinned[number(i - 1)])
            CHECK(all.vertices.old_to_new[number(i - 1)] < all.vertices.old_to_new[number(i)]);
    }
    CHECK(solution_order(m).order.vertices.new_to_old == all.vertices.new_to_old);
    CHECK(solution_order(m).free_count == m.vertex_count());

    const auto same = permute(m, identity_order(m));
    CHECK(same.points() == m.points());
    CHECK(same.cells() == m.cells());
}
