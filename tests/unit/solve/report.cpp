// SPDX-License-Identifier: MIT
#include <locale>
#include <sstream>

#include <doctest/doctest.h>

#include <taut/impl/core/solve/report.hpp>
#include <taut/solve_params.hpp>

using namespace taut::solve;
using namespace taut::solve::impl;

TEST_CASE("report: a run that was continued reads as one")
{
    report first{.stop = stop::decrease,
                 .iterations = 2,
                 .evaluations = 9,
                 .gradients = 3,
                 .products = 5,
                 .value_start = 8,
                 .value = 6,
                 .seconds = 0.5,
                 .waits = 6,
                 .capping = {},
                 .history = {{.iteration = 0, .value = 8}, {.iteration = 1, .value = 7}, {.iteration = 2, .value = 6}}};
    report next{.stop = stop::gradient,
                .iterations = 1,
                .evaluations = 4,
                .gradients = 2,
                .products = 3,
                .value_start = 6,
                .value = 5,
                .gradient_norm = 1e-7,
                .seconds = 0.25,
                .waits = 3,
                .capping = {4},
                .history = {{.iteration = 0, .value = 6},
                            {.iteration = 1, .value = 5, .evaluations = 4, .seconds = 0.25, .waits = 3}}};

    const report both = joined(first, next);
    CHECK(both.stop == stop::gradient);
    CHECK(both.iterations == 3);
    CHECK(both.evaluations == 13);
    CHECK(both.gradients == 5);
    CHECK(both.products == 8);
    CHECK(both.value_start == 8);
    CHECK(both.value == 5);
    CHECK(both.gradient_norm == 1e-7);
    CHECK(both.seconds == 0.75);
    CHECK(both.waits == 9);
    CHECK(both.capping == std::vector<int>{4});
    REQUIRE(both.history.size() == 4);
    CHECK(both.history[2].value == 6);
    CHECK(both.history[3].iteration == 3);
    CHECK(both.history[3].value == 5);
    CHECK(both.history[3].evaluations == 13);
    CHECK(both.history[3].seconds == 0.75);
    CHECK(both.history[3].waits == 9);
}

namespace
{

/// Numbers as in some countries: 1.234,5.
struct other_customs : std::numpunct<char>
{
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

} // namespace

TEST_CASE("report: reads the same in every locale")
{
    report r;
    r.stop = stop::gradient;
    r.iterations = 12345;
    r.value_start = 34.5;
    r.value = 7.25;
    const std::locale foreign(std::locale::classic(), new other_customs);
    const std::locale before = std::locale::global(foreign);
    std::ostringstream line;
    line << r;
    std::locale::global(before);
    CHECK(line.getloc() == foreign);
    CHECK(line.str() == "stop: gradient, 12345 iterations, E 34.5 -> 7.25");
}
