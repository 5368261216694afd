// SPDX-License-Identifier: MIT
#include "functions.hpp"

#include <doctest/doctest.h>

#include <taut/impl/core/solve/line/backtracking.hpp>
#include <taut/impl/core/solve/line/bracket.hpp>
#include <taut/impl/core/solve/line/hybrid.hpp>
#include <taut/impl/core/solve/line/line_search.hpp>
#include <taut/impl/core/solve/line/strong_wolfe.hpp>

#include <functional>
#include <string>

using namespace taut::solve;
using namespace taut::solve::impl;

namespace
{

struct test_line
{
    std::string name;
    std::function<double(double)> f, df;
};

/// Functions for line searches: the three hard ones of Moré & Thuente 1994, a parabola, a well near a barrier.
std::vector<test_line> lines()
{
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const double b = 2, b2 = 0.004;
    return {
        {"parabola", [](double a) { return (a - 3) * (a - 3); }, [](double a) { return 2 * (a - 3); }},
        {"More-Thuente 1", [b](double a) { return -a / (a * a + b); },
         [b](double a) { return (a * a - b) / ((a * a + b) * (a * a + b)); }},
        {"More-Thuente 2", [b2](double a) { return std::pow(a + b2, 5) - 2 * std::pow(a + b2, 4); },
         [b2](double a) { return 5 * std::pow(a + b2, 4) - 8 * std::pow(a + b2, 3); }},
        {"barrier", [](double a) { return a < 1e-3 ? -2 * a - 1e-6 * std::log(1e-3 - a) : infinite; },
         [](double a) { return -2 + 1e-6 / (1e-3 - a); }},
        {"far", [](double a) { return std::pow(a - 1e4, 2) / 1e8; }, [](double a) { return 2 * (a - 1e4) / 1e8; }},
    };
}

bool strong_wolfe_holds(const test_line& l, double a, const wolfe_params& p)
{
    return l.f(a) <= l.f(0) + p.sufficient_decrease * a * l.df(0) &&
           std::abs(l.df(a)) <= p.curvature * std::abs(l.df(0));
}

} // namespace

TEST_CASE("interpolation: the minimum of the cubic or the parabola, from either side")
{
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const auto cubic = [](double a) {
        return line_point{a, a * a * a + 1.95 * a * a - 4.2 * a, 3 * (a - 0.7) * (a + 2)};
    };
    CHECK(interpolate(cubic(0), cubic(2)) == doctest::Approx(0.7));
    CHECK(interpolate(cubic(2), cubic(0)) == doctest::Approx(0.7));
    CHECK(interpolate(cubic(0.5), cubic(1.5)) == doctest::Approx(0.7));
    const auto parabola = [](double a) { return line_point{a, (a - 0.6) * (a - 0.6), 2 * (a - 0.6)}; };
    const auto value_alone = [&](double a) { return line_point{a, parabola(a).value, unknown}; };
    CHECK(interpolate(parabola(0), value_alone(2)) == doctest::Approx(0.6));
    CHECK(interpolate(parabola(2), value_alone(0)) == doctest::Approx(0.6));
}

TEST_CASE("interpolation: a tenth of the interval from its ends at least, and its middle where nothing is known")
{
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const auto parabola = [](double a, double least) {
        return line_point{a, (a - least) * (a - least), 2 * (a - least)};
    };
    CHECK(interpolate(parabola(1, 1.01), parabola(3, 1.01)) == doctest::Approx(1.2));
    CHECK(interpolate(parabola(1, 2.99), parabola(3, 2.99)) == doctest::Approx(2.8));
    CHECK(interpolate(parabola(3, 1.01), parabola(1, 1.01)) == doctest::Approx(1.2));
    CHECK(interpolate(parabola(1, 2), {3, infinite, 1}) == 2);
    CHECK(interpolate({1, 5, 0}, {3, 5, 0}) == 2); // flat
    CHECK(interpolate({3, 5, 0}, {1, 5, 0}) == 2);
}

TEST_CASE("strong wolfe: steps grow by a factor until the bound, which is accepted for a decrease")
{
    functions::line falls([](double a) { return -a; }, [](double) { return -1.0; }, 10);
    const auto r = strong_wolfe(falls, 1, {}, 30);
    CHECK(r.status == search_status::accepted);
    CHECK(r.at.step == 10);
    CHECK(falls.evaluations == 5); // 1, 2.5, 6.25, 10, and 10 to land on
}

TEST_CASE("strong wolfe: a step that is no lower than the last one ends the search for longer ones")
{
    // Falls, jumps up at 0.6 and falls again for good: at 1 it is where it was at 0.4.
    functions::line phi([](double a) { return a < 0.6 ? -a : -0.2 - 0.5 * (a - 0.6); },
                        [](double a) { return a < 0.6 ? -1.0 : -0.5; }, 10);
    REQUIRE(phi.value(1.0) == phi.value(0.4));
    const auto r = strong_wolfe(phi, 0.4, {.curvature = 0.1}, 30);
    CHECK(r.status == search_status::accepted);
    CHECK(r.at.step > 0.4);
    CHECK(r.at.step < 0.6);
    CHECK(phi.longest == 1);
}

TEST_CASE("strong wolfe: returned steps have both conditions, evaluated anew")
{
    for (const auto& l : lines())
        for (const double curvature : {0.9, 0.5, 0.1})
            for (const double first : {1e-3, 0.1, 1.0, 10.0, 1000.0})
            {
                CAPTURE(l.name);
                CAPTURE(curvature);
                CAPTURE(first);
                const wolfe_params p{.curvature = curvature};
                functions::line phi(l.f, l.df);
                const auto r = strong_wolfe(phi, first, p, 60);
                REQUIRE(r.status == search_status::accepted);
                CHECK(strong_wolfe_holds(l, r.at.step, p));
                CHECK(r.at.value == l.f(r.at.step));
                CHECK(r.at.slope == l.df(r.at.step));
            }
}

TEST_CASE("hybrid: a full step with the strong Wolfe conditions costs one value and one gradient")
{
    const test_line l{"", [](double a) { return (a - 1.1) * (a - 1.1); }, [](double a) { return 2 * (a - 1.1); }};
    functions::line phi(l.f, l.df);
    const auto r = hybrid(phi, 1, {}, {}, false);
    CHECK(r.status == search_status::accepted);
    CHECK(r.at.step == 1);
    CHECK(phi.evaluations == 1);
    CHECK(phi.gradients == 1);
}

TEST_CASE("hybrid: where the full step is rejected it finds the minimum along the line, with one more gradient")
{
    for (const auto& l : lines())
        for (const int batch : {1, 6})
            for (const double first : {1e-4, 0.02, 1.0, 300.0})
            {
                CAPTURE(l.name);
                CAPTURE(batch);
                CAPTURE(first);
                functions::line phi(l.f, l.df, std::numeric_limits<double>::infinity(), batch);
                const auto r = hybrid(phi, first, {}, {.evaluations = 40}, false);
                REQUIRE(r.status == search_status::accepted);
                if (r.at.step == first)
                    CHECK(strong_wolfe_holds(l, first, {}));
                else
                {
                    CHECK(r.at.value < l.f(0.99 * r.at.step)); // a minimum
                    CHECK(r.at.value < l.f(1.01 * r.at.step));
                    CHECK(phi.gradients == 2);
                }
            }
}

TEST_CASE("hybrid: batches bracket in fewer passes")
{
    const auto l = lines()[4];
    functions::line one(l.f, l.df), six(l.f, l.df, std::numeric_limits<double>::infinity(), 6);
    CHECK(hybrid(one, 1, {}, {}, false).status == search_status::accepted);
    CHECK(hybrid(six, 1, {}, {}, false).status == search_status::accepted);
    CHECK(one.passes >= 7);
    CHECK(six.passes == 2);
}

TEST_CASE("bracket: the triplet is lower in the middle, or ends at the bound")
{
    for (const auto& l : lines())
        for (const int batch : {1, 3, 16})
            for (const double first : {1e-4, 0.02, 1.0, 300.0})
            {
                CAPTURE(l.name);
                CAPTURE(batch);
                CAPTURE(first);
                functions::line phi(l.f, l.df, 500, batch);
                const auto t = bracket(phi, {.step = first, .value = phi.value(first)}, 4, 30);
                REQUIRE(t.found);
                CHECK(t.value == l.f(t.b));
                CHECK(l.f(t.b) < l.f(t.a));
                if (t.capped)
                    CHECK(t.b == 500);
                else
                {
                    CHECK(l.f(t.b) <= l.f(t.c));
                    CHECK(t.a < t.b);
                    CHECK(t.b < t.c);
                }
                CHECK(phi.longest <= 500);
            }
}

TEST_CASE("bracket: from too long a step the longest rung that is a minimum among its neighbours")
{
    for (const int batch : {0, 1, 2, 16})
    {
        CAPTURE(batch);
        functions::line phi([](double a) { return (a - 1) * (a - 1); }, [](double a) { return 2 * (a - 1); }, 500,
                            batch);
        const auto t = bracket(phi, {.step = 7.6, .value = phi.value(7.6)}, 4, 30);
        REQUIRE(t.found);
        CHECK_FALSE(t.capped);
        // A pass of one rung is below phi(0) and looks no further.
        CHECK(t.b == (batch < 2 ? 1.9 : 0.475));
        CHECK(t.c == (batch < 2 ? 7.6 : 1.9));
        CHECK(t.a == (batch < 16 ? 0 : 0.475 / 4));
    }
    // Of two rungs of one value, the longer.
    const auto f = [](double a) { return (a - 5.0 / 32) * (a - 5.0 / 32); };
    functions::line even(
        f, [](double a) { return 2 * (a - 5.0 / 32); }, 500, 16);
    const auto t = bracket(even, {.step = 1, .value = even.value(1)}, 4, 30);
    CHECK(t.b == 0.25);
    CHECK(t.a == 0.0625);
    CHECK(t.c == 1);
}

TEST_CASE("bracket: a first step at the bound ends there, and one no lower than the start is too long")
{
    functions::line falls([](double a) { return -a; }, [](double) { return -1.0; }, 1);
    const auto end = bracket(falls, {.step = 1, .value = -1}, 4, 30);
    CHECK(end.found);
    CHECK(end.capped);
    CHECK(end.b == 1);
    CHECK(falls.evaluations == 0);
    functions::line parabola([](double a) { return (a - 1) * (a - 1); }, [](double a) { return 2 * (a - 1); });
    const auto t = bracket(parabola, {.step = 2, .value = 1}, 4, 30);
    CHECK(t.found);
    CHECK(t.value < 1);
    CHECK(t.b == 0.5);
}

TEST_CASE("bracket: gives up on a function that never rises, and on one that never falls")
{
    functions::line falls([](double a) { return -a; }, [](double) { return -1.0; });
    CHECK_FALSE(bracket(falls, {.step = 1, .value = -1}, 4, 20).found);
    CHECK(falls.evaluations == 20);
    functions::line rises([](double a) { return 1 + a; }, [](double) { return -1.0; }); // a lying slope
    CHECK_FALSE(bracket(rises, {.step = 1, .value = 2}, 4, 100).found);
    CHECK(rises.evaluations < 30); // ends where steps are lost in rounding
    functions::line limited([](double a) { return 1 + a; }, [](double) { return -1.0; });
    CHECK_FALSE(bracket(limited, {.step = 1, .value = 2}, 4, 3).found);
    CHECK(limited.evaluations == 3);
}

TEST_CASE("backtracking: the longest step of its ladder with sufficient decrease, and one gradient")
{
    for (const int batch : {1, 5})
    {
        functions::line phi([](double a) { return a < 0.3 ? -a : 7.0; }, [](double) { return -1.0; },
                            std::numeric_limits<double>::infinity(), batch);
        const auto r = backtracking(phi, 1, {}, 0.5, 30);
        REQUIRE(r.status == search_status::accepted);
        CHECK(r.at.step == 0.25);
        CHECK(phi.gradients == 1);
    }
}

TEST_CASE("line searches: no trial is beyond the bound, and the bound itself is accepted for a decrease")
{
    const test_line l{"", [](double a) { return -a; }, [](double) { return -1.0; }};
    for (const auto method :
         {line_search_method::hybrid, line_search_method::strong_wolfe, line_search_method::backtracking})
    {
        functions::line phi(l.f, l.df, 0.37, 6);
        const auto r = search(phi, 1, {.method = method}, false);
        CHECK(r.status == search_status::accepted);
        CHECK(r.at.step == 0.37);
        CHECK(phi.longest == 0.37);
    }
}

TEST_CASE("line searches: fail on a direction along which nothing falls, and say so")
{
    const test_line l{"", [](double a) { return 1 + a; }, [](double) { return -1.0; }}; // the slope lies
    for (const auto method :
         {line_search_method::hybrid, line_search_method::strong_wolfe, line_search_method::backtracking})
    {
        functions::line phi(l.f, l.df);
        CHECK(search(phi, 1, {.method = method}, false).status == search_status::failed);
        CHECK(phi.evaluations < 120);
    }
}

TEST_CASE("line searches: an interruption ends them at once")
{
    const auto l = lines()[4];
    for (const auto method :
         {line_search_method::hybrid, line_search_method::strong_wolfe, line_search_method::backtracking})
        for (const int limit : {1, 2, 3})
        {
            functions::line phi(l.f, l.df);
            phi.limit = limit;
            const auto r = search(phi, 1e-3, {.method = method}, false);
            CHECK((r.status == search_status::interrupted || phi.evaluations < limit || r.at.step == 1e-3));
            CHECK(phi.evaluations <= limit);
        }
}

TEST_CASE("secant: finds a step from slopes where values are constant to rounding")
{
    for (const double first : {1e-3, 0.3, 1.0, 2.5, 40.0})
    {
        functions::line phi([](double) { return 5.0; }, [](double a) { return (a - 1) * (2 + std::tanh(a)); });
        const auto r = secant(phi, first, {.curvature = 0.1}, 40);
        REQUIRE(r.status == search_status::accepted);
        CHECK(phi.slope() == r.at.slope); // the gradient was taken at the step
        CHECK(r.at.slope >= -0.1 * 2);
        CHECK(r.at.slope < 2);
    }
}

TEST_CASE("wolfe conditions: the approximate form holds only where the value does not rise above rounding")
{
    const functions::line phi([](double) { return 1.0; }, [](double) { return -1.0; });
    const wolfe_conditions wolfe(phi, wolfe_params{});
    CHECK(wolfe.approximate(1 + 5e-15, 0.0));
    CHECK_FALSE(wolfe.approximate(1 + 1e-12, 0.0));
    CHECK_FALSE(wolfe.approximate(0.9, 0.0));   // far below: a matter for the value
    CHECK_FALSE(wolfe.approximate(1.0, -0.95)); // too steep still
    CHECK_FALSE(wolfe.approximate(1.0, 1.1));   // far past the minimum
    CHECK_FALSE(wolfe.armijo(1e-20, 1.0));      // a decrease that rounds to nothing is none
    CHECK(wolfe.blind(1e-13));
    CHECK_FALSE(wolfe.blind(1e-9));
}
