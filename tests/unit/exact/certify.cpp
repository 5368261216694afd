// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include <taut/certify.hpp>
#include <taut/impl/core/mesh/ideal.hpp>

#include "support/meshes.hpp"

namespace
{

using taut::certify;
using taut::vec2;
using taut::vec3;

std::vector<vec2> flat(const taut::mesh<taut::triangle>& m, double x = 1, double y = 1)
{
    std::vector<vec2> uv;
    for (const auto& p : m.points()) uv.emplace_back(x * p.x, y * p.y);
    return uv;
}

} // namespace

TEST_CASE("certify: a planar grid is its own injective map with det 1")
{
    const auto m = taut::test::grid(7, 5);
    const taut::impl::ideal_elements<taut::triangle> ideal(m);
    const auto c = certify<2>(m.cells(), flat(m), ideal.measure);
    CHECK(static_cast<bool>(c));
    CHECK(c.elements == 70);
    CHECK(c.flipped == 0);
    CHECK(c.ids.empty());
    CHECK(c.min_det == doctest::Approx(1));
    CHECK(c.max_det == doctest::Approx(1));
    CHECK(certify<2>(m.cells(), flat(m, 2, 3), ideal.measure).max_det == doctest::Approx(6));
}

TEST_CASE("certify: a certificate takes over all that another one found")
{
    const taut::certificate found{
        .elements = 9, .flipped = 2, .ids = {3, 5}, .branched = 1, .branch_ids = {7}, .min_det = -1, .max_det = 4};
    taut::certificate c{.min_det = 0.5, .max_det = 2};
    c.take_defects(found);
    CHECK(c.elements == 9);
    CHECK(c.flipped == 2);
    CHECK(c.ids == found.ids);
    CHECK(c.branched == 1);
    CHECK(c.branch_ids == found.branch_ids);
    CHECK(c.min_det == 0.5);
    CHECK(c.max_det == 2);
    CHECK(c.defects() == 3);
}

TEST_CASE("certify: a mirrored map has every element flipped, and ids stop at the limit")
{
    const auto m = taut::test::grid(7, 5);
    const taut::impl::ideal_elements<taut::triangle> ideal(m);
    const auto c = certify<2>(m.cells(), flat(m, -1, 1), ideal.measure, 5);
    CHECK_FALSE(static_cast<bool>(c));
    CHECK(c.flipped == 70);
    CHECK(c.ids == std::vector<taut::idx>{0, 1, 2, 3, 4});
    CHECK(c.max_det == doctest::Approx(-1));
}

TEST_CASE("certify: a vertex moved across an edge is found with its triangles")
{
    const auto m = taut::test::grid(2, 2);
    auto uv = flat(m);
    uv[4] = {0.5, 1.5}; // the centre, out over the top side
    const auto c = certify<2>(m.cells(), uv);
    CHECK(c.flipped > 0);
    CHECK(c.min_det < 0);
    for (const auto id : c.ids)
    {
        const auto& t = m.cells()[static_cast<std::size_t>(id)];
        CHECK((t[0] == 4 || t[1] == 4 || t[2] == 4));
    }
}

TEST_CASE("certify: flat and non-finite triangles count as flipped")
{
    const std::vector<std::array<taut::idx, 3>> cells{{0, 1, 2}};
    CHECK(certify<2>(cells, std::vector<vec2>{{0, 0}, {0.1, 0.1}, {0.3, 0.3}}).flipped == 1);
    const auto broken =
        certify<2>(cells, std::vector<vec2>{{0, 0}, {1, 0}, {0, std::numeric_limits<double>::quiet_NaN()}});
    CHECK(broken.flipped == 1);
    CHECK(std::isnan(broken.min_det));
    CHECK(certify<2>({}, {}).flipped == 0);
}

TEST_CASE("certify: a triangle with an area below rounding is judged by its exact sign")
{
    const double u = std::ldexp(1.0, -52);
    const std::vector<std::array<taut::idx, 3>> cells{{0, 1, 2}, {0, 2, 1}};
    const auto c = certify<2>(cells, std::vector<vec2>{{0, 0}, {1 + u, 1 + 2 * u}, {1, 1 + u}});
    CHECK(c.flipped == 1);
    CHECK(c.ids == std::vector<taut::idx>{1});
    CHECK(c.max_det == u * u);
}

TEST_CASE("certify: tetrahedra of a cube, as they are and turned inside out")
{
    const auto m = taut::test::cube(3);
    const taut::impl::ideal_elements<taut::tetrahedron> ideal(m);
    const auto c = certify<3>(m.cells(), m.points(), ideal.measure);
    CHECK(c.elements == 162);
    CHECK(c.flipped == 0);
    CHECK(c.min_det == doctest::Approx(1));
    CHECK(c.max_det == doctest::Approx(1));
    auto x = m.points();
    for (auto& p : x) p.z = -p.z;
    CHECK(certify<3>(m.cells(), x, ideal.measure).flipped == 162);
}
