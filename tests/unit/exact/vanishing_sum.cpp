// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <taut/impl/core/untangle/proofs/vanishing_sum.hpp>

using taut::impl::big_integer;

namespace
{

big_integer whole(double x)
{
    return big_integer::scaled(x, 0);
}

bool equal(const big_integer& a, const big_integer& b)
{
    return (a - b).sign() == 0;
}

/// Of some hundred bits.
big_integer random_integer(std::mt19937& random, int factors)
{
    std::uniform_real_distribution<double> u(-1, 1);
    big_integer x = whole(1);
    for (int k = 0; k < factors; ++k) x = x * big_integer::scaled(u(random), 80);
    return x;
}

} // namespace

TEST_CASE("big_integer: sums, products and signs are those of numbers")
{
    std::mt19937 random(1);
    std::uniform_int_distribution<std::int64_t> u(-(1LL << 30), 1LL << 30);
    for (int k = 0; k < 1000; ++k)
    {
        const auto a = u(random), b = u(random), c = u(random);
        const auto x = whole(double(a)), y = whole(double(b)), z = whole(double(c));
        CHECK(equal(x + y, whole(double(a + b))));
        CHECK(equal(x - y, whole(double(a - b))));
        CHECK((x * y + z).sign() == (a * b + c > 0 ? 1 : a * b + c < 0 ? -1 : 0));
        CHECK((x * y).rounded(0) == doctest::Approx(double(a) * double(b)));
    }
    CHECK(whole(0).sign() == 0);
    CHECK((whole(3) - whole(3)).sign() == 0);
    CHECK(whole(1024).bits() == 11);
}

TEST_CASE("big_integer: a product divided by one of its factors is the other one")
{
    std::mt19937 random(2);
    for (int k = 0; k < 300; ++k)
    {
        const auto a = random_integer(random, 1 + k % 7), b = random_integer(random, 1 + k % 5);
        CHECK(equal((a * b).quotient(b), a));
        CHECK(equal((a * b).quotient(a), b));
        CHECK(equal((a + b) * (a - b), a * a - b * b));
    }
    CHECK(whole(0).quotient(whole(8)).sign() == 0);
    CHECK(equal(whole(-96).quotient(whole(32)), whole(-3)));
}

TEST_CASE("big_integer: numbers are scaled by the least power of two that makes them whole")
{
    CHECK(big_integer::least_power(0.375) == 3);
    CHECK(equal(big_integer::scaled(0.375, 3), whole(3)));
    CHECK(big_integer::least_power(-12) == -2);
    CHECK(equal(big_integer::scaled(-12, -2), whole(-3)));
    CHECK(equal(big_integer::scaled(0.1, big_integer::least_power(0.1) + 2),
                big_integer::scaled(0.1, big_integer::least_power(0.1)) * whole(4)));
}

TEST_CASE("fit_nonnegative: least squares within the cone of the columns")
{
    const std::vector<std::vector<double>> columns{{1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    const auto inside = taut::impl::fit_nonnegative(columns, {2, 3, 0});
    CHECK(inside.error() < 1e-12);
    for (const double w : inside.weights) CHECK(w >= 0);
    const auto beside = taut::impl::fit_nonnegative(columns, {2, -3, 4});
    CHECK(beside.error() == doctest::Approx(5));
    CHECK(beside.weights[1] == 0);
}

TEST_CASE("vanishes: only where weights that are not negative make the sum 0, to the last digit")
{
    using taut::impl::vanishes;
    const auto columns = [](std::vector<std::vector<double>> numbers)
    {
        std::vector<std::vector<big_integer>> result;
        for (const auto& c : numbers)
        {
            result.emplace_back();
            for (const double x : c) result.back().push_back(whole(x));
        }
        return result;
    };
    CHECK(vanishes(columns({{1, 0}, {0, 1}, {-2, -5}})));
    CHECK(vanishes(columns({{0, 1, 0}, {0, -3, 0}})));            // a row that no pivot is in
    CHECK(!vanishes(columns({{1, 0}, {0, 1}, {-2, 5}})));         // a weight would be negative
    CHECK(!vanishes(columns({{1, 0}, {0, 1}})));                  // independent
    CHECK(!vanishes(columns({{1, 0}, {-1, 0}, {2, 0}, {0, 0}}))); // more than one choice

    // Three multiples of two long vectors' sums, and the same but for one unit.
    std::mt19937 random(3);
    std::vector<std::vector<big_integer>> c(3, std::vector<big_integer>(5));
    for (std::size_t r = 0; r < 5; ++r)
    {
        c[0][r] = random_integer(random, 3);
        c[1][r] = random_integer(random, 3);
        c[2][r] = -(whole(7) * c[0][r] + whole(12345) * c[1][r]);
    }
    CHECK(vanishes(c));
    c[2][4] = c[2][4] + whole(1);
    CHECK(!vanishes(c));
}
