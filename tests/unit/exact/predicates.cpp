// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include <taut/impl/core/exact/predicates.hpp>

namespace
{

using taut::vec2;
using taut::vec3;
using taut::impl::orient2d;
using taut::impl::orient3d;

__extension__ using wide = __int128; // the oracle: integers that hold the whole determinant

int sign(wide x)
{
    return x > 0 ? 1 : x < 0 ? -1 : 0;
}

using point2 = std::array<std::int64_t, 2>;
using point3 = std::array<std::int64_t, 3>;

int oracle(const point2& a, const point2& b, const point2& c)
{
    return sign(wide(b[0] - a[0]) * (c[1] - a[1]) - wide(b[1] - a[1]) * (c[0] - a[0]));
}

int oracle(const point3& a, const point3& b, const point3& c, const point3& d)
{
    const auto e = [&a](const point3& p, int k) { return wide(p[std::size_t(k)] - a[std::size_t(k)]); };
    wide det = 0;
    for (int x = 0; x < 3; ++x)
    {
        const int y = (x + 1) % 3;
        const int z = (x + 2) % 3;
        det += e(b, x) * (e(c, y) * e(d, z) - e(c, z) * e(d, y));
    }
    return sign(det);
}

vec2 scaled(const point2& p, int exponent)
{
    return {std::ldexp(double(p[0]), exponent), std::ldexp(double(p[1]), exponent)};
}

vec3 scaled(const point3& p, int exponent)
{
    return {std::ldexp(double(p[0]), exponent), std::ldexp(double(p[1]), exponent), std::ldexp(double(p[2]), exponent)};
}

/// Three points that are collinear but for a few units in the last place.
std::array<point2, 3> nearly_collinear(std::mt19937_64& random, int bits)
{
    std::uniform_int_distribution<std::int64_t> coordinate(-(std::int64_t{1} << bits), std::int64_t{1} << bits);
    std::uniform_int_distribution<std::int64_t> noise(-1, 1);
    const point2 a{coordinate(random), coordinate(random)};
    const point2 b{coordinate(random), coordinate(random)};
    point2 middle{(a[0] + b[0]) / 2 + noise(random), (a[1] + b[1]) / 2 + noise(random)};
    return {a, b, middle};
}

} // namespace

TEST_CASE("predicates: orientation of plain simplices")
{
    CHECK(orient2d({0, 0}, {1, 0}, {0, 1}) == 1);
    CHECK(orient2d({0, 0}, {0, 1}, {1, 0}) == -1);
    CHECK(orient2d({0, 0}, {1, 1}, {3, 3}) == 0);
    CHECK(taut::impl::orient(vec2(1, 1), vec2(3, 1), vec2(1, 4)).det == 6);
    CHECK(orient2d({0.1, 0.3}, {0.1, 0.3}, {7, 1e-300}) == 0); // corners in one place
    CHECK(orient2d({7, 1e-300}, {0.1, 0.3}, {0.1, 0.3}) == 0);
    CHECK(orient2d({0.1, 0.3}, {7, 1e-300}, {0.1, 0.3}) == 0);
    CHECK(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}) == 1);
    CHECK(orient3d({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}) == -1);
    CHECK(orient3d({0, 0, 0}, {1, 2, 3}, {4, 5, 6}, {7, 8, 9}) == 0);
    CHECK(taut::impl::orient(vec3(0), vec3(2, 0, 0), vec3(0, 3, 0), vec3(0, 0, 4)).det == 24);
}

TEST_CASE("predicates: orient2d agrees with integers on nearly collinear points at every scale")
{
    std::mt19937_64 random(1);
    int decided_by_rounding = 0;
    for (int n = 0; n < 3000; ++n)
    {
        const auto [a, b, c] = nearly_collinear(random, 52);
        const int expected = oracle(a, b, c);
        for (const int exponent : {0, -52, 400, -560, -1070})
        {
            // At 2^-1070 all coordinates are still exact: their magnitudes are integers times 2^-1070.
            REQUIRE(orient2d(scaled(a, exponent), scaled(b, exponent), scaled(c, exponent)) == expected);
            REQUIRE(orient2d(scaled(b, exponent), scaled(a, exponent), scaled(c, exponent)) == -expected);
            REQUIRE(orient2d(scaled(c, exponent), scaled(a, exponent), scaled(b, exponent)) == expected);
        }
        const double det = (double(b[0]) - double(a[0])) * (double(c[1]) - double(a[1])) -
                           (double(b[1]) - double(a[1])) * (double(c[0]) - double(a[0]));
        if ((det > 0) - (det < 0) != expected) ++decided_by_rounding;
    }
    CHECK(decided_by_rounding > 15); // the inputs are hard: plain arithmetic gets many of them wrong
}

TEST_CASE("predicates: orient2d sees a change of one unit in the last place of a far point")
{
    const vec2 a(12, 12);
    const vec2 b(24, 24);
    CHECK(orient2d(a, b, {0.5, 0.5}) == 0);
    CHECK(orient2d(a, b, {0.5, std::nextafter(0.5, 1.0)}) == 1);
    CHECK(orient2d(a, b, {std::nextafter(0.5, 1.0), 0.5}) == -1);
    const double tiny = std::numeric_limits<double>::denorm_min();
    CHECK(orient2d({0, 0}, {1e300, 1e300}, {tiny, 0}) == -1);
    CHECK(orient2d({0, 0}, {tiny, 0}, {0, tiny}) == 1);
    CHECK(orient2d({-1e308, 0}, {1e308, 0}, {0, 1e308}) == 1);
    CHECK(orient2d({1e308, 1e308}, {-1e308, -1e308}, {tiny, 2 * tiny}) == -1);
}

TEST_CASE("predicates: orient3d agrees with integers on nearly coplanar points at every scale")
{
    std::mt19937_64 random(2);
    std::uniform_int_distribution<std::int64_t> coordinate(-(1LL << 37), 1LL << 37);
    std::uniform_int_distribution<std::int64_t> noise(-1, 1);
    for (int n = 0; n < 3000; ++n)
    {
        std::array<point3, 4> p;
        for (std::size_t k = 0; k < 3; ++k) p[k] = {coordinate(random), coordinate(random), coordinate(random)};
        for (std::size_t k = 0; k < 3; ++k) p[3][k] = p[0][k] / 2 + p[1][k] / 4 + p[2][k] / 4 + noise(random);
        const int expected = oracle(p[0], p[1], p[2], p[3]);
        for (const int exponent : {0, -37, 300, -400, -1070})
        {
            std::array<vec3, 4> q;
            for (std::size_t k = 0; k < 4; ++k) q[k] = scaled(p[k], exponent);
            REQUIRE(orient3d(q[0], q[1], q[2], q[3]) == expected);
            REQUIRE(orient3d(q[1], q[0], q[2], q[3]) == -expected);
            REQUIRE(orient3d(q[1], q[2], q[0], q[3]) == expected);
            REQUIRE(orient3d(q[3], q[1], q[2], q[0]) == -expected);
        }
    }
}

TEST_CASE("predicates: orient3d is exact where products overflow or vanish")
{
    const double tiny = std::numeric_limits<double>::denorm_min();
    const double huge = std::numeric_limits<double>::max();
    CHECK(orient3d({0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}, {0, 0, tiny}) == 1);
    CHECK(orient3d({0, 0, 0}, {huge, 0, 0}, {0, huge, 0}, {0, 0, huge}) == 1);
    CHECK(orient3d({-huge, -huge, 0}, {huge, -huge, 0}, {0, huge, 0}, {0, 0, -tiny}) == -1);
    CHECK(orient3d({0, 0, 0}, {huge, huge, huge}, {tiny, 0, 0}, {0, tiny, 0}) == 1);
}

TEST_CASE("predicates: the determinant has the exact sign and a few ulps")
{
    const double u = std::ldexp(1.0, -52);
    // (1 + u)(1 + u) - (1 + 2u) = u^2, far below what the plain difference keeps.
    const auto o = taut::impl::orient(vec2(0, 0), vec2(1 + u, 1 + 2 * u), vec2(1, 1 + u));
    CHECK(o.sign == 1);
    CHECK(o.det == u * u);
    const auto mirrored = taut::impl::orient(vec2(0, 0), vec2(1, 1 + u), vec2(1 + u, 1 + 2 * u));
    CHECK(mirrored.sign == -1);
    CHECK(mirrored.det == -u * u);
}

TEST_CASE("predicates: a coordinate that is not finite has no orientation")
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    CHECK(orient2d({0, 0}, {1, 0}, {0, nan}) == 0);
    CHECK(orient2d({0, 0}, {1, 0}, {0, infinity}) == 0);
    CHECK(std::isnan(taut::impl::orient(vec2(0, 0), vec2(1, 0), vec2(0, infinity)).det));
    CHECK(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, nan}) == 0);
}

TEST_CASE("exact sum: the magnitude of every power of two, and of sums that cancel, is exact")
{
    for (int e = -1074; e < 1024; e += 3)
    {
        const double power = std::ldexp(1.0, e);
        taut::impl::exact_sum<2> sum;
        sum.add(false, {power, 1.0});
        CHECK(sum.sign() == 1);
        CHECK(sum.magnitude() == power);
        // Smaller than the product that cancels by more than a double can tell.
        taut::impl::exact_sum<2> rest;
        rest.add(true, {power, 1.0});
        rest.add(false, {std::ldexp(1.0, 600), 3.0});
        rest.add(true, {std::ldexp(1.0, 601), 1.0});
        rest.add(true, {std::ldexp(1.0, 600), 1.0});
        CHECK(rest.sign() == -1);
        CHECK(rest.magnitude() == power);
    }
}

TEST_CASE("exact sum: the products of the largest numbers have a place")
{
    const double large = std::ldexp(1.0, 1023);
    for (const bool negative : {false, true})
    {
        taut::impl::exact_sum<2> two;
        two.add(negative, {large, large});
        CHECK(two.sign() == (negative ? -1 : 1));
        taut::impl::exact_sum<3> three;
        for (int k = 0; k < 24; ++k) three.add(negative, {large, large, large});
        CHECK(three.sign() == (negative ? -1 : 1));
    }
}
