// SPDX-License-Identifier: MIT
#include "functions.hpp"

#include "support/two_loop.hpp"
#include <doctest/doctest.h>

using namespace taut::solve;
using namespace taut::solve::impl;

namespace
{

report run(std::vector<double>& x, conjugate_gradient_params p, double curvature = 0.9, double tolerance = 1e-9)
{
    auto f = functions::rosenbrock(x.size());
    return minimize(f, x,
                    {.method = method::conjugate_gradient,
                     .gradient_tolerance = tolerance,
                     .max_iterations = 5000,
                     .tuning = {.line = {.wolfe = {.curvature = curvature}}, .conjugate_gradient = p}});
}

} // namespace

TEST_CASE("conjugate gradient: minimises Rosenbrock's function with either beta, with and without preconditioner")
{
    for (const auto beta : {conjugacy::hestenes_stiefel, conjugacy::polak_ribiere})
        for (const int pairs : {0, 1, 8})
            for (const std::size_t n : {2, 10, 50})
            {
                CAPTURE(int(beta));
                CAPTURE(pairs);
                CAPTURE(n);
                std::vector<double> x = n < 4 ? functions::rosenbrock_start(n) : std::vector<double>(n, 0.3);
                const auto r = run(x, {.beta = beta, .memory = {.pairs = pairs}}, 0.1);
                CHECK(r.stop == stop::gradient);
                CHECK(functions::distance(x, 1) < 1e-5);
                CHECK(functions::largest_rise(r) == 0);
            }
}

TEST_CASE("conjugate gradient: plain and with exact searches it solves a quadratic in as many steps as eigenvalues")
{
    for (const auto beta : {conjugacy::hestenes_stiefel, conjugacy::polak_ribiere})
    {
        // 30 variables, 5 eigenvalues.
        host_objective f(30,
                         [](std::span<const double> x, std::span<double> g)
                         {
                             double value = 0;
                             for (std::size_t i = 0; i < 30; ++i)
                             {
                                 g[i] = double(1 + i % 5) * (x[i] - 1);
                                 value += g[i] * (x[i] - 1) / 2;
                             }
                             return value;
                         });
        std::vector<double> x = functions::noise(30);
        const auto r = minimize(
            f, x,
            {.method = method::conjugate_gradient,
             .gradient_tolerance = 1e-6,
             .tuning = {.line = {.wolfe = {.curvature = 0.001}, .exact = {.tolerance = 1e-9, .evaluations = 60}},
                        .conjugate_gradient = {.beta = beta, .memory = {.pairs = 0}}}});
        CHECK(r.stop == stop::gradient);
        CHECK(r.iterations >= 5);
        CHECK(r.iterations <= 6); // one for the inexactness of Brent
    }
}

TEST_CASE("conjugate gradient: the next direction is conjugate, y'd = 0, whatever the search")
{
    // The defining property of the Hestenes-Stiefel beta in its consistent form, for every preconditioner.
    const host_space space(5);
    for (const int pairs : {0, 1, 3})
    {
        gram_inverse_hessian<const host_space> h(space, {.pairs = pairs});
        conjugate_rule rule({});
        std::vector<double> g = functions::noise(5, 3), d(5), g_new = g;
        h.start(g);
        int momenta = 0;
        for (int k = 0; k < 6; ++k)
        {
            h.multiply(g);
            const momentum m = rule(h);
            const auto info = h.direction(m.on_step, d);
            CHECK(info.slope < 0);
            if (m.on_step > 0)
            {
                ++momenta;
                std::vector<double> y = g_new;
                space.axpby(-1, g, 1, y); // g_new still holds the gradient before
                CHECK(std::abs(space.dot(y, d)) <= 1e-12 * std::sqrt(space.dot(y, y) * space.dot(d, d)));
            }
            // A step that is far too long on 1/2 x'diag(1..5) x: s'g > 0.
            g_new = g;
            const double a = 0.7 * (k + 1);
            for (std::size_t i = 0; i < 5; ++i) g_new[i] += a * double(i + 1) * d[i];
            h.propose(a, d, g, g_new);
            REQUIRE(h.accept());
            std::swap(g, g_new);
        }
        CHECK(momenta >= 4);
    }
}

TEST_CASE("conjugate gradient: the preconditioner pays")
{
    std::vector<double> x(50, 0.3), y = x;
    const auto plain = run(x, {.memory = {.pairs = 0}}), preconditioned = run(y, {.memory = {.pairs = 8}});
    CHECK(preconditioned.iterations < plain.iterations);
    CHECK(preconditioned.evaluations < plain.evaluations / 2);
}

TEST_CASE("conjugate gradient: restarts as often as told")
{
    std::vector<double> x(10, 0.3);
    const auto r = run(x, {.restart_interval = 5});
    CHECK(r.stop == stop::gradient);
    CHECK(r.restarts >= r.iterations / 5 - 1);
    CHECK(r.restarts <= r.iterations / 5 + 1);
}

TEST_CASE("conjugate gradient: both forms of the preconditioner give the same iterates to rounding")
{
    for (const auto beta : {conjugacy::hestenes_stiefel, conjugacy::polak_ribiere})
    {
        auto f = functions::chain(50);
        std::vector<double> x = functions::noise(50), y = x;
        const params p{.method = method::conjugate_gradient,
                       .line_search = line_search_method::strong_wolfe, // Brent's steps are noise from 1e-8 on
                       .gradient_tolerance = 0,
                       .max_iterations = 30,
                       .tuning = {.conjugate_gradient = {.beta = beta, .memory = {.pairs = 3}}}};
        minimize(f, x, p);
        minimize_by_two_loops(f, y, p);
        CHECK(functions::distance(x, y) < 1e-10);
    }
}

TEST_CASE("gradient descent: converges on a mild quadratic, more slowly than the others")
{
    auto f = functions::quadratic(20, 50);
    std::vector<double> x(20, -2.0), y = x;
    const auto descent = minimize(f, x, {.method = method::gradient_descent});
    const auto lbfgs = minimize(f, y);
    CHECK(descent.stop == stop::gradient);
    CHECK(descent.iterations > lbfgs.iterations);
    CHECK(functions::distance(x, 1) < 1e-3);
}
