// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <taut/impl/core/solve/line/brent.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using taut::solve::impl::brent;
using taut::solve::impl::brent_tolerance;

namespace
{

template <class F>
taut::solve::impl::brent_result run(F f, double a, double b, double c, brent_tolerance t = {})
{
    return brent(f, a, b, c, f(b), t);
}

} // namespace

TEST_CASE("brent: finds the minima of classic functions to its tolerance")
{
    const auto root = run([](double x) { return x * x * x - 2 * x - 5; }, 0.0, 1.0, 2.0);
    CHECK(root.x == doctest::Approx(std::sqrt(2.0 / 3)).epsilon(1e-7));
    CHECK(root.converged);

    CHECK(run([](double x) { return std::cos(x); }, 2, 3, 5).x == doctest::Approx(std::numbers::pi).epsilon(1e-7));
    CHECK(run([](double x) { return x - std::log(x); }, 0.01, 0.5, 9).x == doctest::Approx(1).epsilon(1e-7));
    CHECK(run([](double x) { return std::abs(x - 0.3); }, -1, 0.1, 2).x == doctest::Approx(0.3).epsilon(1e-6));
    CHECK(run([](double x) { return std::pow(x - 2, 4) + 1; }, 0, 1, 7).x == doctest::Approx(2).epsilon(1e-3));
    CHECK(std::abs(run([](double x) { return x * x; }, -1, 0.5, 1).x) < 1e-11); // absolute tolerance: a minimum at 0
}

TEST_CASE("brent: Brent's own sum of poles, in each of its valleys")
{
    // f(x) = sum over i of ((2 i - 5) / (x - i^2))^2: 19 minima between the poles (Brent 1973, table 5.1, first rows).
    const auto f = [](double x)
    {
        double sum = 0;
        for (int i = 1; i <= 20; ++i) sum += std::pow((2 * i - 5) / (x - i * i), 2);
        return sum;
    };
    for (int i = 1; i < 20; ++i)
    {
        const double low = i * i, high = (i + 1) * (i + 1), x = run(f, low, low + 0.4 * (high - low), high).x;
        const double h = 1e-4 * (high - low); // lower than both sides, and flat
        CHECK(f(x) < f(x - h));
        CHECK(f(x) < f(x + h));
        CHECK(std::abs(f(x + h) - f(x - h)) < 1e-2 * (f(x + h) - f(x)));
    }
    CHECK(run(f, 1, 2, 4).x == doctest::Approx(3.0229153).epsilon(1e-7));
    CHECK(run(f, 4, 6, 9).x == doctest::Approx(6.6837536).epsilon(1e-7));
}

TEST_CASE("brent: a parabola takes few evaluations")
{
    for (const double minimum : {0.5, 0.7, 0.9})
        for (const double start : {0.1, 0.45, 0.95}) // from either side
        {
            const auto r = run([=](double x) { return (x - minimum) * (x - minimum); }, 0, start, 1);
            CHECK(r.x == doctest::Approx(minimum).epsilon(1e-7));
            CHECK(r.evaluations <= 8);
        }
}

TEST_CASE("brent: stays in the interval, stops at its budget, and tolerates infinite values")
{
    std::vector<double> visited;
    const auto barrier = [&](double x)
    {
        visited.push_back(x);
        return x < 0.75 ? 1 / (0.75 - x) - 8 * x : std::numeric_limits<double>::infinity();
    };
    const auto r = run(barrier, 0, 0.1, 10);
    CHECK(r.x == doctest::Approx(0.75 - std::sqrt(1.0 / 8)).epsilon(1e-6));
    for (const double x : visited)
    {
        CHECK(x > 0);
        CHECK(x < 10);
    }

    const auto five = run([](double x) { return std::cosh(x - 3); }, 0, 1, 9, {.max_evaluations = 5});
    CHECK(five.evaluations == 5);
    CHECK_FALSE(five.converged);
    CHECK(std::cosh(five.x - 3) < std::cosh(1.0 - 3));
    CHECK(five.value == std::cosh(five.x - 3));
}
