// SPDX-License-Identifier: MIT
#include "functions.hpp"

#include <doctest/doctest.h>

#include <sstream>
#include <stdexcept>

using namespace taut::solve;
using namespace taut::solve::impl;

TEST_CASE("stopping: a start that is not finite is a result, not an exception")
{
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    {
        host_objective value(1,
                             [&](std::span<const double>, std::span<double> g)
                             {
                                 g[0] = 1;
                                 return bad;
                             });
        host_objective gradient(1,
                                [&](std::span<const double>, std::span<double> g)
                                {
                                    g[0] = bad;
                                    return 1.0;
                                });
        std::vector<double> x{4};
        CHECK(minimize(value, x).stop == stop::not_finite_start);
        CHECK(minimize(gradient, x).stop == stop::not_finite_start);
        CHECK(x[0] == 4);
    }
}

TEST_CASE("stopping: a start at the minimum takes no step")
{
    auto f = functions::quadratic(3, 10);
    std::vector<double> x(3, 1.0);
    const auto r = minimize(f, x);
    CHECK(r.stop == stop::gradient);
    CHECK(r.iterations == 0);
    CHECK(r.evaluations == 1);
    CHECK(r.history.size() == 1);
}

TEST_CASE("stopping: the iteration limit keeps the best iterate, and more iterations go on from there")
{
    auto f = functions::rosenbrock(6);
    double before = std::numeric_limits<double>::infinity();
    for (const int limit : {0, 1, 2, 5, 11, 20})
    {
        std::vector<double> x(6, 0.3);
        const auto r = minimize(f, x, {.gradient_tolerance = 1e-12, .max_iterations = limit});
        CHECK(r.stop == stop::iterations);
        CHECK(r.iterations == limit);
        CHECK(r.history.size() == std::size_t(limit) + 1);
        CHECK(r.value == f.value(x));
        for (const auto& entry : r.history) CHECK(entry.value >= r.value);
        CHECK(r.value < before);
        before = r.value;
    }
}

TEST_CASE("stopping: the observer sees every iterate and ends the run within one iteration")
{
    for (const int limit : {0, 1, 3, 4, 10})
    {
        auto f = functions::rosenbrock(10);
        std::vector<double> x(10, 0.3);
        int asked = 0, iterates = 0;
        const auto ask = [&](const taut::progress& p)
        {
            iterates += p.iterate;
            return asked++ < limit;
        };
        const auto r = minimize(f, x, {}, {.observer = ask});
        CHECK(r.stop == stop::user);
        CHECK(asked == limit + 1);
        CHECK(r.evaluations <= limit + 1); // nothing was computed after the answer
        CHECK(iterates == r.iterations + 1);
        CHECK(r.value == f.value(x));
        CHECK(r.value <= r.value_start);
    }

    auto f = functions::rosenbrock(10);
    std::vector<double> x(10, 0.3);
    std::vector<double> values;
    const auto watch = [&](const taut::progress& p)
    {
        if (p.iterate) values.push_back(p.value);
        return true;
    };
    const auto r = minimize(f, x, {}, {.observer = watch});
    REQUIRE(values.size() == r.history.size());
    for (std::size_t i = 0; i < values.size(); ++i) CHECK(values[i] == r.history[i].value);
}

TEST_CASE("stopping: an exception of the observer passes through and leaves the last iterate")
{
    auto f = functions::rosenbrock(4);
    std::vector<double> x(4, 0.3);
    double value = 0;
    const auto fail = [&](const taut::progress& p)
    {
        value = p.value;
        if (p.iteration == 3) throw std::runtime_error("enough");
        return true;
    };
    CHECK_THROWS_AS(minimize(f, x, {}, {.observer = fail}), std::runtime_error);
    CHECK(f.value(x) == value);
}

TEST_CASE("stopping: the time limit ends the run in the middle of a line search")
{
    using clock = taut::impl::budget::clock;
    constexpr auto limit = std::chrono::milliseconds(20);
    int calls = 0, late = 0;
    clock::time_point first;
    host_objective f(2,
                     [&](std::span<const double> x, std::span<double> g)
                     {
                         if (calls++ == 0) first = clock::now();
                         late += clock::now() > first + limit;
                         while (calls == 3 && clock::now() <= first + limit)
                         {
                         }
                         g[0] = 4 * std::pow(x[0] - 1, 3);
                         g[1] = 4e4 * std::pow(x[1] - 1, 3);
                         return std::pow(x[0] - 1, 4) + 1e4 * std::pow(x[1] - 1, 4);
                     });
    std::vector<double> x{30, -20};
    const auto r = minimize(f, x, {.gradient_tolerance = 0}, {.time_limit = limit});
    CHECK(r.stop == stop::time);
    CHECK(calls <= 3);
    CHECK(late == 0); // nothing is computed after the limit
    CHECK(r.evaluations == calls);
    CHECK(r.seconds >= 0.02);
    CHECK(r.value <= r.value_start);
    CHECK_THROWS_AS(minimize(f, x, {}, {.time_limit = std::chrono::seconds(-1)}), taut::parameter_error);
}

TEST_CASE("stopping: a failing line search restarts with steepest descent once, then keeps the best iterate")
{
    // The gradient has the wrong sign: nothing ever falls.
    int gradients = 0;
    host_objective wrong(2,
                         [&](std::span<const double> x, std::span<double> g)
                         {
                             ++gradients;
                             g[0] = -x[0];
                             g[1] = -x[1];
                             return (x[0] * x[0] + x[1] * x[1]) / 2;
                         });
    std::vector<double> x{1, 2};
    auto r = minimize(wrong, x);
    CHECK(r.stop == stop::line_search);
    CHECK(r.iterations == 0);
    CHECK(r.restarts == 0); // the first direction was steepest descent already
    CHECK(x == std::vector<double>{1, 2});

    // A gradient that turns wrong after a few steps.
    host_objective turns(2,
                         [](std::span<const double> p, std::span<double> g)
                         {
                             const double sign = p[0] * p[0] + p[1] * p[1] < 0.5 ? -1 : 1;
                             g[0] = sign * 2 * p[0];
                             g[1] = sign * 20 * p[1];
                             return p[0] * p[0] + 10 * p[1] * p[1];
                         });
    x = {1, 2};
    r = minimize(turns, x);
    CHECK(r.stop == stop::line_search);
    CHECK(r.iterations > 0);
    CHECK(r.restarts >= 1);
    CHECK(r.value < r.value_start);
    CHECK(r.value == turns.value(x));
}

TEST_CASE("stopping: small decreases count when they come in a row")
{
    stopping_test test({.gradient_tolerance = 0, .decrease_tolerance = 1e-3, .tuning = {.decrease_count = 2}}, 1e-14);
    CHECK_FALSE(test.start(1).has_value());
    step_record k{.iteration = 1, .value_before = 10, .value = 9.999, .gradient = 0.5, .length = 1, .capped = false};
    CHECK_FALSE(test.after(k).has_value());
    k.value = 9; // a large one in between
    CHECK_FALSE(test.after(k).has_value());
    k.value = 9.999;
    CHECK_FALSE(test.after(k).has_value());
    CHECK(test.after(k) == stop::decrease);
}

TEST_CASE("stopping: decreases along capped steps do not mean convergence, but many of them mean a barrier")
{
    stopping_test test({.gradient_tolerance = 0, .decrease_tolerance = 1e-3, .tuning = {.barrier_count = 4}}, 1e-14);
    test.start(1);
    const step_record k{
        .iteration = 1, .value_before = 10, .value = 9.999, .gradient = 0.5, .length = 1, .capped = true};
    for (int i = 0; i < 3; ++i) CHECK_FALSE(test.after(k).has_value());
    CHECK(test.after(k) == stop::barrier);
}

TEST_CASE("stopping: decreases lost in rounding do not count while the gradient falls")
{
    stopping_test test({.gradient_tolerance = 1e-9, .decrease_tolerance = 1e-10}, 1e-14);
    test.start(1);
    step_record k{.iteration = 1, .value_before = 10, .value = 10, .gradient = 1e-5, .length = 1, .capped = false};
    for (; k.gradient > 1e-8; k.gradient /= 2) CHECK_FALSE(test.after(k).has_value());
    int more = 0;
    while (!test.after(k)) ++more; // no new low any more
    CHECK(more == 11);             // the low of the first of them, ten more, and the second that counts
}

TEST_CASE("stopping: two promises in a row of next to nothing above the base mean convergence, one does not")
{
    stopping_test test({.gradient_tolerance = 1e-6, .tuning = {.base = 4}}, 1e-14);
    test.start(1);
    step_record k{.iteration = 1, .value_before = 14.1, .value = 14, .gradient = 1e-4, .length = 1};
    CHECK_FALSE(test.after(k).has_value()); // nothing promised
    k.promised = 0.9e-7;
    CHECK_FALSE(test.after(k).has_value());
    k.promised = 1.1e-7;
    CHECK_FALSE(test.after(k).has_value());
    k.promised = 0.9e-7;
    CHECK_FALSE(test.after(k).has_value());
    CHECK(test.after(k) == stop::decrement);

    stopping_test never({.gradient_tolerance = 0}, 1e-14);
    never.start(1);
    for (int i = 0; i < 5; ++i) CHECK_FALSE(never.after(k).has_value());
}

TEST_CASE("stopping: a run has settled where five Newton steps together gain next to nothing near a minimum")
{
    const stopping_params params{.tuning = {.base = 4, .settled_tolerance = 1e-3}};
    const step_record little{.iteration = 1, .value_before = 14, .value = 13.999, .gradient = 1e-2, .newton = true};
    /// Steps until it ends, of at most nine: `others` first, then like k, each from where the last one ended.
    const auto steps = [&](const step_record& k, const stopping_params& p, std::vector<step_record> others = {})
    {
        stopping_test test(p, 1e-14);
        test.start(1);
        double value = 14;
        for (int n = 1; n < 10; ++n)
        {
            step_record next = k;
            if (!others.empty())
            {
                next = others.front();
                others.erase(others.begin());
            }
            next.value = value - (next.value_before - next.value);
            next.value_before = value;
            value = next.value;
            const auto stop = test.after(next);
            if (!stop) continue;
            CHECK(stop == stop::settled);
            return n;
        }
        return 10;
    };
    CHECK(steps(little, params) == 5);

    step_record much = little;
    much.value = 13.995; // 5 and 4 more are 9e-3, of 10
    CHECK(steps(little, params, {much}) == 5);
    CHECK(steps(little, params, {much, much}) == 6);
    CHECK(steps(much, params) == 10);

    step_record other = little;
    other.newton = false;
    CHECK(steps(other, params) == 10);
    other = little;
    other.gradient = 1.01e-2; // far from a minimum, though little is gained
    CHECK(steps(other, params) == 10);
    CHECK(steps(little, params, {other, other}) == 7);
    other = little;
    other.promised = 1e-3; // a full step along a definite Hessian
    CHECK(steps(other, params) == 10);
    CHECK(steps(little, params, {other, other, other, other}) == 5); // only the last one matters

    CHECK(steps(little, {.tuning = {.base = 4, .settled_tolerance = 1e-6}}) == 10);
    CHECK(steps(little, {}) == 10);
    CHECK_FALSE(stopping_params{}.tuning.settled_tolerance > 0);
}

TEST_CASE("stopping: steps are measured by the longest one")
{
    stopping_test test({.gradient_tolerance = 0, .decrease_tolerance = 0, .tuning = {.step_tolerance = 1e-2}}, 1e-14);
    test.start(1);
    step_record k{.iteration = 1, .value_before = 10, .value = 9, .gradient = 1, .length = 5, .capped = false};
    CHECK_FALSE(test.after(k).has_value());
    k.length = 0.04;
    CHECK_FALSE(test.after(k).has_value());
    CHECK(test.after(k) == stop::step);
}

TEST_CASE("stopping: each tolerance ends a real run")
{
    auto f = functions::quadratic(20, 1e4, 1.0);
    const auto reason = [&](params p)
    {
        std::vector<double> x(20, 3.0);
        p.max_iterations = 2000;
        return minimize(f, x, p).stop;
    };
    CHECK(reason({.gradient_tolerance = 1e-5}) == stop::gradient);
    CHECK(reason({.gradient_tolerance = 0, .decrease_tolerance = 1e-4}) == stop::decrease);
    CHECK(
        reason({.gradient_tolerance = 0, .decrease_tolerance = 0, .tuning = {.stopping = {.step_tolerance = 1e-3}}}) ==
        stop::step);
}

TEST_CASE("report: prints one line and keeps the stream's format")
{
    report r;
    r.stop = stop::gradient;
    r.iterations = 7;
    r.value_start = 34.5;
    r.value = 7.44640666;
    std::ostringstream out;
    out << r << ' ' << 1.23456789;
    CHECK(out.str() == "stop: gradient, 7 iterations, E 34.5 -> 7.446 1.23457");
    r.iterations = 1;
    r.stop = stop::not_finite_start;
    std::ostringstream one;
    one << r;
    CHECK(one.str() == "stop: start not finite, 1 iteration, E 34.5 -> 7.446");
}

TEST_CASE("report: every stop has a name of its own")
{
    std::vector<std::string_view> names;
    for (const auto reason :
         {stop::gradient, stop::decrement, stop::settled, stop::decrease, stop::step, stop::iterations,
          stop::line_search, stop::barrier, stop::time, stop::user, stop::not_finite_start})
    {
        for (const auto other : names) CHECK(other != to_string(reason));
        names.push_back(to_string(reason));
        CHECK(to_string(reason) != "unknown");
    }
}
