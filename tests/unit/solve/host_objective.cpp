// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <taut/solve.hpp>

#include <cstddef>
#include <span>
#include <vector>

TEST_CASE("host objective: a point of another size is refused by name")
{
    using namespace taut::solve;
    host_objective f(3,
                     [](std::span<const double> x, std::span<double> g)
                     {
                         double sum = 0;
                         for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * x[i], g[i] = 2 * x[i];
                         return sum;
                     });
    for (const std::size_t size : {0, 2, 5})
    {
        std::vector<double> x(size, 2.0);
        CHECK_THROWS_WITH_AS(minimize(f, x), doctest::Contains("numbers for a function of 3"), taut::parameter_error);
        CHECK(x == std::vector<double>(size, 2.0));
    }
    std::vector<double> x(3, 2.0);
    CHECK(minimize(f, x).stop == stop::gradient);
}
