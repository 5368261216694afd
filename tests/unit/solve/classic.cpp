// SPDX-License-Identifier: MIT
#include "functions.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <string>

#include <taut/impl/core/solve/stop.hpp>

using namespace taut::solve;
using namespace taut::solve::impl;

namespace
{

using function = std::function<double(std::span<const double>, std::span<double>)>;

struct problem
{
    std::string name;
    std::vector<double> start, minimum;
    double tolerance; ///< on the point, at a relative gradient of 1e-10
    function f;
};

/// From Moré, Garbow & Hillstrom 1981, with its starts.
std::vector<problem> problems()
{
    return {{"Beale",
             {1, 1},
             {3, 0.5},
             1e-8,
             [](std::span<const double> x, std::span<double> g)
             {
                 double value = g[0] = g[1] = 0;
                 const double y[] = {1.5, 2.25, 2.625};
                 for (int i = 1; i <= 3; ++i)
                 {
                     const double power = std::pow(x[1], i), r = y[i - 1] - x[0] * (1 - power);
                     value += r * r;
                     g[0] -= 2 * r * (1 - power);
                     g[1] += 2 * r * x[0] * i * std::pow(x[1], i - 1);
                 }
                 return value;
             }},
            {"Wood",
             {-3, -1, -3, -1},
             {1, 1, 1, 1},
             1e-6,
             [](std::span<const double> x, std::span<double> g)
             {
                 const double a = x[1] - x[0] * x[0], b = 1 - x[0], c = x[3] - x[2] * x[2], d = 1 - x[2];
                 const double e = x[1] + x[3] - 2, h = x[1] - x[3];
                 g[0] = -400 * a * x[0] - 2 * b;
                 g[1] = 200 * a + 20 * e + h / 5;
                 g[2] = -360 * c * x[2] - 2 * d;
                 g[3] = 180 * c + 20 * e - h / 5;
                 return 100 * a * a + b * b + 90 * c * c + d * d + 10 * e * e + h * h / 10;
             }},
            {"Powell singular", // a singular Hessian at the minimum
             {3, -1, 0, 1},
             {0, 0, 0, 0},
             2e-2,
             [](std::span<const double> x, std::span<double> g)
             {
                 const double a = x[0] + 10 * x[1], b = x[2] - x[3], c = x[1] - 2 * x[2], d = x[0] - x[3];
                 g[0] = 2 * a + 40 * std::pow(d, 3);
                 g[1] = 20 * a + 4 * std::pow(c, 3);
                 g[2] = 10 * b - 8 * std::pow(c, 3);
                 g[3] = -10 * b - 40 * std::pow(d, 3);
                 return a * a + 5 * b * b + std::pow(c, 4) + 10 * std::pow(d, 4);
             }},
            {"Brown, badly scaled",
             {1, 1},
             {1e6, 2e-6},
             1e-3,
             [](std::span<const double> x, std::span<double> g)
             {
                 const double a = x[0] - 1e6, b = x[1] - 2e-6, c = x[0] * x[1] - 2;
                 g[0] = 2 * a + 2 * c * x[1];
                 g[1] = 2 * b + 2 * c * x[0];
                 return a * a + b * b + c * c;
             }}};
}

} // namespace

TEST_CASE("minimize: solves classic problems from their classic starts with every line search")
{
    for (const auto& p : problems())
        for (const auto which : {method::lbfgs, method::conjugate_gradient})
            for (const auto search :
                 {line_search_method::hybrid, line_search_method::strong_wolfe, line_search_method::backtracking})
            {
                CAPTURE(p.name);
                CAPTURE(int(which));
                CAPTURE(int(search));
                host_objective f(p.start.size(), p.f);
                std::vector<double> x = p.start;
                const auto r = minimize(
                    f, x,
                    {.method = which, .line_search = search, .gradient_tolerance = 1e-10, .max_iterations = 2000});
                CAPTURE(r);
                CHECK(converged(r.stop));
                CHECK(functions::distance(x, p.minimum) <= p.tolerance);
                CHECK(functions::largest_rise(r) <= 1e-14);
            }
}

TEST_CASE("minimize: noise in values is tolerated where the objective states its rounding")
{
    // Values rounded to float, as of an energy that is computed in single precision; gradients stay smooth.
    struct rounded : host_space
    {
        using host_space::host_space;
        using point = std::vector<double>;
        decltype(functions::chain(2)) chain = functions::chain(components());
        const host_space& space() const { return *this; }
        point make_point() const { return make(); }
        double value(const point& x) { return double(float(chain.value(x))); }
        double value_gradient(const point& x, point& g) { return double(float(chain.value_gradient(x, g))); }
        void step(const point& x, double a, const point& d, point& out) { chain.step(x, a, d, out); }
        double rounding() const { return 1e-7; }
    };

    for (const auto search : {line_search_method::hybrid, line_search_method::strong_wolfe})
    {
        rounded f(50);
        std::vector<double> x = functions::noise(50);
        const auto r = minimize(f, x, {.line_search = search, .gradient_tolerance = 1e-8});
        CAPTURE(r);
        CHECK(r.stop == stop::gradient); // far below the 3e-4 that the values could tell
        CHECK(functions::largest_rise(r) <= 1e-7);
        CHECK(r.evaluations < 500);
    }
}
