// SPDX-License-Identifier: MIT
#include <array>
#include <random>
#include <set>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/certify.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/impl/core/mesh/refine_elements.hpp>
#include <taut/mesh.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

template <class Element>
double whole_measure(const mesh<Element>& m)
{
    double sum = 0;
    for (taut::idx c = 0; c < m.cell_count(); ++c)
    {
        const auto rest = m.rest(c);
        typename Element::mapped_corners x;
        for (std::size_t k = 0; k < x.size(); ++k) x[k] = vec<Element::dimension>(rest[k]);
        sum += Element::determinant(x) * Element::measure_factor;
    }
    return sum;
}

/// Splits some simplices of so many vertices of every third cell, larger ones first.
template <class Element>
subdivision some_splits(const mesh<Element>& m)
{
    subdivision how(m.vertex_count());
    std::mt19937 random(5);
    for (std::size_t size = Element::corners; size >= 2; --size)
        for (std::size_t c = 0; c < m.cells().size(); c += 3)
        {
            auto t = m.cells()[c];
            std::shuffle(t.begin(), t.end(), random);
            how.split({t.begin(), t.begin() + static_cast<std::ptrdiff_t>(size)});
        }
    return how;
}

template <class Element>
void check_refinement(const mesh<Element>& m)
{
    const auto how = some_splits(m);
    const auto [refined, cells] = refine_elements(m, how);
    CHECK(refined.vertex_count() == how.vertex_count());
    CHECK(refined.cell_count() > m.cell_count());
    CHECK(std::is_sorted(cells.begin(), cells.end()));
    CHECK(std::set<taut::idx>(cells.begin(), cells.end()).size() == m.cells().size());
    for (std::size_t v = 0; v < m.points().size(); ++v) CHECK(refined.points()[v] == m.points()[v]);
    // No hanging nodes: a facet of one element only lies on the boundary, which has the measure that it had.
    const auto f = facets(refined);
    CHECK(f.oriented());
    double before = 0, after = 0;
    const auto size = [](const auto& mesh, const auto& facet)
    {
        const auto x = [&](std::size_t k) { return mesh.points()[static_cast<std::size_t>(facet[k])]; };
        if constexpr (Element::dimension == 2)
            return glm::distance(x(0), x(1));
        else
            return glm::length(glm::cross(x(1) - x(0), x(2) - x(0)));
    };
    for (const auto& facet : boundary_facets(m)) before += size(m, facet);
    for (const auto& facet : boundary_facets(refined)) after += size(refined, facet);
    CHECK(after == doctest::Approx(before));
    CHECK(whole_measure(refined) == doctest::Approx(whole_measure(m)));
    std::vector<vec<Element::dimension>> x(refined.points().begin(), refined.points().end());
    CHECK(certify<Element::dimension>(refined.cells(), std::span<const vec<Element::dimension>>(x)));
}

} // namespace

TEST_CASE("refine_elements: edges, faces and cells are split, neighbours with them, and all parts are positive")
{
    check_refinement(test::grid(5, 4));
    check_refinement(test::jittered_cube(3, 1));
}

TEST_CASE("refine_elements: parts of an element are equally large and keep its orientation")
{
    const mesh<tetrahedron> m({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
    for (const auto& [simplex, parts] : {std::pair{std::vector<taut::idx>{3, 1}, 2}, {{2, 0, 3}, 3}, {{0, 1, 2, 3}, 4}})
    {
        subdivision how(4);
        CHECK(how.split(simplex) == 4);
        CHECK(how.split(simplex) == 4); // it is split already
        const auto r = refine_elements(m, how);
        CHECK(r.refined.cell_count() == parts);
        for (taut::idx c = 0; c < parts; ++c)
            CHECK(tetrahedron::determinant(r.refined.rest(c)) == doctest::Approx(1.0 / parts));
    }
}

TEST_CASE("refine_elements: what is no simplex, or of another mesh, is refused")
{
    subdivision how(4);
    CHECK_THROWS_AS(how.split({1}), parameter_error);
    CHECK_THROWS_AS(how.split({0, 0}), parameter_error);
    CHECK_THROWS_AS(how.split({0, 4}), parameter_error);
    CHECK_THROWS_AS(how.split({-1, 2}), parameter_error);
    CHECK_THROWS_AS(how.split({0, 1, 2, 3, 3}), parameter_error);
    CHECK_THROWS_AS(refine_elements(test::grid(2, 2), how), parameter_error);
}
