// SPDX-License-Identifier: MIT
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/types.hpp>

// Small numbers are compared as ratios: doctest's Approx is absolute below 1.
namespace
{

using namespace taut;
using taut::idx;

mesh<triangle> one(vec3 a, vec3 b, vec3 c)
{
    return {{a, b, c}, {{0, 1, 2}}};
}

/// Edge matrix A of cell c at rest, for a planar surface or a volume.
mat2 edges(const mesh<triangle>& m, taut::idx c)
{
    const auto x = m.rest(c);
    return mat2(vec2(x[1] - x[0]), vec2(x[2] - x[0]));
}
mat3 edges(const mesh<tetrahedron>& m, taut::idx c)
{
    const auto x = m.rest(c);
    return mat3(x[1] - x[0], x[2] - x[0], x[3] - x[0]);
}

template <int D>
void check_rotation(const mat<D>& S)
{
    const mat<D> I = glm::transpose(S) * S;
    for (int c = 0; c < D; ++c)
        for (int r = 0; r < D; ++r) CHECK(I[c][r] == doctest::Approx(c == r ? 1.0 : 0.0).epsilon(1e-12));
    CHECK(glm::determinant(S) == doctest::Approx(1.0).epsilon(1e-12));
}

} // namespace

TEST_CASE("ideal: at rest S is a rotation and the measures add up")
{
    const auto disk = test::flat_disk(8);
    const taut::impl::ideal_elements<triangle> flat(disk);
    double area = 0;
    for (taut::idx c = 0; c < disk.cell_count(); ++c)
    {
        check_rotation<2>(edges(disk, c) * flat.inverse[static_cast<std::size_t>(c)]);
        area += flat.measure[static_cast<std::size_t>(c)];
    }
    CHECK(area == doctest::Approx(0.5 * 48 * std::sin(2 * std::numbers::pi / 48)).epsilon(1e-12)); // 48-gon

    const auto solid = test::cube(3);
    const taut::impl::ideal_elements<tetrahedron> tets(solid);
    double volume = 0;
    for (taut::idx c = 0; c < solid.cell_count(); ++c)
    {
        check_rotation<3>(edges(solid, c) * tets.inverse[static_cast<std::size_t>(c)]);
        volume += tets.measure[static_cast<std::size_t>(c)];
    }
    CHECK(volume == doctest::Approx(1.0).epsilon(1e-12));
}

TEST_CASE("ideal: a triangle in space has the cotangent form of eq. 9 with the lambda of eq. 18")
{
    std::mt19937 rng(1);
    std::uniform_real_distribution<double> u(-1, 1);
    for (int trial = 0; trial < 200; ++trial)
    {
        const vec3 a(u(rng), u(rng), u(rng)), b(u(rng), u(rng), u(rng)), c(u(rng), u(rng), u(rng));
        const auto cot = [](vec3 p, vec3 q) { return glm::dot(p, q) / glm::length(glm::cross(p, q)); };
        const double alpha = cot(b - a, c - a), beta = cot(a - b, c - b);
        const double E = 0.5 * glm::length(glm::cross(b - a, c - a));
        if (E < 1e-2) continue;
        const double lambda = 1 / std::sqrt(2 * E * (alpha + beta));
        const taut::impl::ideal_elements<triangle> e(one(a, b, c));
        CHECK(e.measure[0] == doctest::Approx(E).epsilon(1e-12));
        CHECK(e.inverse[0][0][0] == doctest::Approx(lambda).epsilon(1e-10));
        CHECK(e.inverse[0][1][0] == doctest::Approx(-lambda * alpha).epsilon(1e-10));
        CHECK(e.inverse[0][1][1] == doctest::Approx(lambda * (alpha + beta)).epsilon(1e-10));
        CHECK(e.inverse[0][0][1] == 0.0);
    }
}

TEST_CASE("ideal: the edge matrix has the lengths of the triangle, from positions or from lengths")
{
    const vec3 a(0.1, 0.2, 0.3), b(1.1, -0.4, 0.6), c(0.3, 0.9, -0.7);
    const double l01 = glm::length(b - a), l12 = glm::length(c - b), l20 = glm::length(a - c);
    for (const mat2& W : {triangle::ideal({a, b, c}), triangle::ideal(l01, l12, l20)})
    {
        CHECK(W[0][0] == doctest::Approx(l01));
        CHECK(W[0][1] == 0.0);
        CHECK(glm::length(W[1]) == doctest::Approx(l20));
        CHECK(glm::length(W[1] - W[0]) == doctest::Approx(l12));
        CHECK(W[1][1] > 0);
    }
}

TEST_CASE("ideal: the area of a needle from its edge lengths keeps its digits")
{
    CHECK(triangle::area(3, 4, 5) == 6.0);
    CHECK(triangle::area(5, 3, 4) == 6.0);
    // Isosceles with base 2^-40 and sides 1; Heron's formula as usually written has no digit left.
    const double base = std::ldexp(1.0, -40);
    for (const double area : {triangle::area(1, 1, base), triangle::area(base, 1, 1), triangle::area(1, base, 1)})
        CHECK(area / (0.5 * base) == doctest::Approx(1.0).epsilon(1e-15));
    // Unequal sides, against Heron's formula with 11 more bits.
    for (const auto& [a, b, c] : {std::array{100000.0, 99999.99979, 0.00029}, {99999.99996, 99999.99994, 0.00003}})
    {
        const long double s = (static_cast<long double>(a) + b + c) / 2;
        const auto expected = static_cast<double>(std::sqrt(s * (s - a) * (s - b) * (s - c)));
        CHECK(triangle::area(a, b, c) / expected == doctest::Approx(1.0).epsilon(1e-9));
        CHECK(triangle::area(c, a, b) / expected == doctest::Approx(1.0).epsilon(1e-9));
    }
    CHECK(triangle::area(1, 2, 3) == 0.0);
    CHECK(std::isnan(triangle::area(1, 2, 3.5)));
}

TEST_CASE("ideal: slivers have finite inverses with the right area, whichever corner comes first")
{
    for (int exponent = 1; exponent <= 40; ++exponent)
    {
        // Caps (one angle near pi) and needles (one edge short); exact in binary, so that the area is known.
        const double h = std::ldexp(1.0, -exponent);
        const std::array<std::array<vec3, 3>, 2> shapes = {
            {{vec3(0, 0, 0), vec3(1, 0, 0), vec3(0.5, h, 0)}, {vec3(0, 0, 0), vec3(h, 0, 0), vec3(0.25, 1, 0)}}};
        for (const auto& x : shapes)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const auto m = one(x[k], x[(k + 1) % 3], x[(k + 2) % 3]);
                const taut::impl::ideal_elements<triangle> e(m);
                CHECK(e.measure[0] / (h / 2) == doctest::Approx(1.0).epsilon(1e-14));
                const mat2 S = edges(m, 0) * e.inverse[0];
                CHECK(std::isfinite(norm2(S)));
                CHECK(norm2(S) * 0.5 == doctest::Approx(1.0).epsilon(1e-3));
                CHECK(glm::determinant(S) == doctest::Approx(1.0).epsilon(1e-3));
            }
    }
}

TEST_CASE("ideal: a needle anywhere in space keeps the digits of its area, whichever corner comes first")
{
    std::mt19937 rng(8);
    std::uniform_real_distribution<double> u(-1, 1);
    for (int trial = 0; trial < 100; ++trial)
    {
        const vec3 a(u(rng), u(rng), u(rng));
        std::array<vec3, 3> x = {a, a + 1e-9 * vec3(u(rng), u(rng), u(rng)), vec3(u(rng), u(rng), u(rng))};
        // The area of the triangle with just these coordinates.
        using wide = glm::vec<3, long double>;
        const wide n = glm::cross(wide(x[1]) - wide(x[0]), wide(x[2]) - wide(x[0]));
        const auto area = static_cast<double>(0.5L * std::sqrt(glm::dot(n, n)));
        if (area < 1e-11) continue;
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(taut::impl::ideal_elements<triangle>(one(x[k], x[(k + 1) % 3], x[(k + 2) % 3])).measure[0] / area ==
                  doctest::Approx(1.0).epsilon(1e-12));
    }
}

TEST_CASE("ideal: a scale far from 1 neither overflows nor vanishes")
{
    const auto base = test::bumpy(4);
    const taut::impl::ideal_elements<triangle> expected(base);
    for (const int exponent : {-1000, -600, -60, 60, 600, 1000})
    {
        const double s = std::ldexp(1.0, exponent);
        auto points = base.points();
        for (vec3& p : points) p *= s;
        const mesh<triangle> m(points, base.cells());
        // Brought back to size by the caller, the result is that of the base mesh.
        const taut::impl::ideal_elements<triangle> e(m, 1 / s);
        for (std::size_t c = 0; c < e.measure.size(); ++c)
        {
            CHECK(e.inverse[c][1][0] == expected.inverse[c][1][0]);
            CHECK(e.inverse[c][1][1] == expected.inverse[c][1][1]);
            CHECK(e.measure[c] == expected.measure[c]);
        }
    }
}

TEST_CASE("ideal: a factor scales lengths, not shapes")
{
    const auto m = test::cube(2);
    const taut::impl::ideal_elements<tetrahedron> a(m), b(m, 4.0);
    for (std::size_t c = 0; c < a.measure.size(); ++c)
    {
        CHECK(b.measure[c] == 64 * a.measure[c]);
        CHECK(b.inverse[c] == a.inverse[c] / 4.0);
    }
}

TEST_CASE("ideal: cells without one are all named")
{
    const mesh<triangle> flat({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {3, 0, 0}},
                              {{0, 1, 2}, {0, 1, 3}, {1, 2, 4}});
    try
    {
        taut::impl::ideal_elements<triangle> e(flat);
        FAIL("no error");
    }
    catch (const mesh_error& e)
    {
        CHECK(e.fault() == mesh_error::degenerate_cell);
        CHECK(e.ids() == std::vector<taut::idx>{0, 2});
    }
    auto cells = test::cube(1).cells();
    std::swap(cells[3][0], cells[3][1]);
    try
    {
        taut::impl::ideal_elements<tetrahedron> e(mesh<tetrahedron>(test::cube(1).points(), cells));
        FAIL("no error");
    }
    catch (const mesh_error& e)
    {
        CHECK(e.fault() == mesh_error::inverted_cell);
        CHECK(e.ids() == std::vector<taut::idx>{3});
    }
}

TEST_CASE("determinant: twice the area and six times the volume, with sign")
{
    CHECK(triangle::determinant({vec2(0, 0), vec2(2, 0), vec2(0, 3)}) == 6.0);
    CHECK(triangle::determinant({vec2(0, 0), vec2(0, 3), vec2(2, 0)}) == -6.0);
    CHECK(tetrahedron::determinant({vec3(0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)}) == 1.0);
    CHECK(tetrahedron::determinant({vec3(0), vec3(0, 1, 0), vec3(1, 0, 0), vec3(0, 0, 1)}) == -1.0);
}
