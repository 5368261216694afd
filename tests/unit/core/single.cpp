// SPDX-License-Identifier: MIT
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <taut/impl/core/core/single.hpp>
#include <taut/types.hpp>

namespace
{

/// By the processor, where nothing can be left out.
double by_conversion(double x)
{
    const volatile float rounded = static_cast<float>(x);
    return static_cast<double>(rounded);
}

bool same_bits(double a, double b)
{
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

} // namespace

TEST_CASE("single precision: numbers are rounded as the processor rounds them, at every magnitude")
{
    std::mt19937_64 random(1);
    for (int i = 0; i < 400'000; ++i)
    {
        std::uint64_t bits = random();
        const std::uint64_t near_float = std::uint64_t(1023 - 160) + random() % 300; // exponents of floats and around
        if (i % 2 == 0) bits = (bits & 0x800f'ffff'ffff'ffff) | (near_float << 52);
        if (i % 5 == 0) bits &= ~std::uint64_t(0x0fff'ffff); // halfway between two
        if (i % 7 == 0) bits &= ~std::uint64_t(0x3fff'ffff);
        const double x = std::bit_cast<double>(bits);
        if (std::isnan(x)) continue;
        CAPTURE(x);
        REQUIRE(same_bits(taut::impl::in_single(x), by_conversion(x)));
    }
    using limits = std::numeric_limits<double>;
    for (const double x : {0.0, -0.0, limits::infinity(), -limits::infinity(), limits::max(), limits::denorm_min(),
                           0x1.ffffffp127, 0x1.fffffefp127, 0x1p-149, 0x1p-150, 0x1.8p-150, -0x1p-126})
    {
        CAPTURE(x);
        CHECK(same_bits(taut::impl::in_single(x), by_conversion(x)));
    }
    CHECK(std::isnan(taut::impl::in_single(limits::quiet_NaN())));
}

TEST_CASE("single precision: all three coordinates of a point are rounded")
{
    std::vector<taut::vec3> points{{16777219.2, 0.1, 0.3}, {0.1, 16777219.2, 0.3}};
    for (taut::vec3& p : points)
        for (int k = 0; k < 3; ++k) p[k] = taut::impl::in_single(p[k]);
    CHECK(points[0].x == 16777220.0);
    CHECK(points[0].y == static_cast<double>(0.1f));
    CHECK(points[1].y == 16777220.0);
    CHECK(points[1].z == static_cast<double>(0.3f));
}
