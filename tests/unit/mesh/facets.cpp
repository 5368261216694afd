// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <random>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/impl/core/mesh/facets.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;

/// Compares the table with a std::map from sorted facets to sides.
template <class Element>
void check_against_map(const mesh<Element>& m)
{
    const auto f = facets(m);
    std::map<std::vector<taut::idx>, std::vector<taut::idx>> sides;
    for (taut::idx s = 0; s < m.cell_count() * Element::corners; ++s)
    {
        const auto v = side_vertices(m, s);
        std::vector<taut::idx> key(v.begin(), v.end());
        std::sort(key.begin(), key.end());
        sides[key].push_back(s);
    }
    REQUIRE(f.twin.size() == static_cast<std::size_t>(m.cell_count()) * Element::corners);
    std::size_t crowds = 0;
    for (const auto& [key, list] : sides)
    {
        const auto at = [&f, &s = list](std::size_t i) { return f.twin[static_cast<std::size_t>(s[i])]; };
        if (list.size() == 1)
            CHECK(at(0) == facet_table::boundary);
        else if (list.size() == 2)
        {
            CHECK(at(0) == list[1]);
            CHECK(at(1) == list[0]);
        }
        else
        {
            ++crowds;
            for (std::size_t i = 0; i < list.size(); ++i) CHECK(at(i) == facet_table::non_manifold);
        }
    }
    CHECK(f.crowds.size() == crowds);
}

} // namespace

TEST_CASE("facets: every side finds its other side")
{
    check_against_map(test::single_triangle());
    check_against_map(test::bumpy(12));
    check_against_map(test::octahedron());
    check_against_map(test::moebius(7));
    check_against_map(test::three_on_an_edge());
    check_against_map(test::fan(300, true));
    check_against_map(test::cube(3));
    check_against_map(test::single_tetrahedron());
}

TEST_CASE("facets: random cells, with crowds and duplicates")
{
    std::mt19937 rng(3);
    for (int trial = 0; trial < 20; ++trial)
    {
        std::vector<std::array<taut::idx, 3>> cells;
        std::vector<std::array<taut::idx, 4>> volumes;
        while (cells.size() < 40)
        {
            std::array<taut::idx, 4> t{};
            for (auto& v : t) v = static_cast<taut::idx>(rng() % 9);
            auto sorted = t;
            std::sort(sorted.begin(), sorted.end());
            if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) continue;
            cells.push_back({t[0], t[1], t[2]});
            volumes.push_back(t);
        }
        check_against_map(mesh<triangle>(std::vector<vec3>(9), cells));
        check_against_map(mesh<tetrahedron>(std::vector<vec3>(9), volumes));
    }
}

TEST_CASE("facets: neighbours that run the same way clash")
{
    CHECK(facets(test::grid(3, 3)).oriented());
    CHECK(facets(test::cube(2)).oriented());

    auto cells = test::grid(1, 1).cells();
    std::swap(cells[1][0], cells[1][1]);
    const auto f = facets(mesh<triangle>(test::grid(1, 1).points(), cells));
    REQUIRE(f.clash.size() == 1);
    CHECK(f.clash[0][0] / 3 == 0);
    CHECK(f.clash[0][1] / 3 == 1);
    CHECK(f.manifold());
    CHECK_FALSE(f.oriented());

    auto tets = test::cube(1).cells();
    std::swap(tets[2][2], tets[2][3]);
    CHECK(facets(mesh<tetrahedron>(test::cube(1).points(), tets)).clash.size() == 2);
}

TEST_CASE("facets: sides are oriented as the boundary of their cell")
{
    const auto tri = test::single_triangle();
    CHECK(side_vertices(tri, 0) == std::array<taut::idx, 2>{1, 2});
    CHECK(side_vertices(tri, 1) == std::array<taut::idx, 2>{2, 0});
    CHECK(side_vertices(tri, 2) == std::array<taut::idx, 2>{0, 1});

    const auto tet = test::single_tetrahedron();
    REQUIRE(tetrahedron::determinant(tet.rest(0)) > 0);
    for (taut::idx s = 0; s < 4; ++s)
    {
        const auto v = side_vertices(tet, s);
        const auto x = [&](int k) { return tet.points()[static_cast<std::size_t>(k)]; };
        const vec3 normal = glm::cross(x(v[1]) - x(v[0]), x(v[2]) - x(v[0]));
        CHECK(glm::dot(normal, x(s) - x(v[0])) < 0); // the opposite corner is behind the face
    }
}
