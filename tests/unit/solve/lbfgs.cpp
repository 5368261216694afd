// SPDX-License-Identifier: MIT
#include "functions.hpp"

#include <limits>
#include <utility>
#include <vector>

#include <taut/impl/core/solve/objective_bodies.hpp>
#include <taut/impl/core/solve/stop.hpp>

#include "support/two_loop.hpp"
#include <doctest/doctest.h>

using namespace taut::solve;
using namespace taut::solve::impl;

namespace
{

constexpr line_search_method searches[] = {line_search_method::hybrid, line_search_method::strong_wolfe,
                                           line_search_method::backtracking};

} // namespace

TEST_CASE("lbfgs: minimises Rosenbrock's function in 2 to 100 dimensions with every line search")
{
    for (const auto method : searches)
        for (const std::size_t n : {2, 3, 10, 30, 100})
        {
            CAPTURE(n);
            CAPTURE(int(method));
            auto f = functions::rosenbrock(n);
            // In 4 and more dimensions there is a second minimum near (-1, 1, ..., 1): start on this side of it.
            std::vector<double> x = n < 4 ? functions::rosenbrock_start(n) : std::vector<double>(n, 0.3);
            const auto r = minimize(f, x, {.line_search = method, .gradient_tolerance = 1e-9});
            CHECK(r.stop == stop::gradient);
            CHECK(functions::distance(x, 1) <= 1e-5);
            CHECK(r.value == f.value(x));
            CHECK(r.gradient_norm <= 1e-9);
            CHECK(functions::largest_rise(r) == 0);
            CHECK(r.iterations < 60 + 8 * int(n));
        }
}

TEST_CASE("lbfgs: with enough memory solves a quadratic of condition 1e8 to 1e-10 of its gradient")
{
    for (const auto method : {line_search_method::hybrid, line_search_method::strong_wolfe})
    {
        auto f = functions::quadratic(12, 1e8);
        std::vector<double> x(12, -3.0);
        const auto r = minimize(f, x,
                                {.line_search = method,
                                 .gradient_tolerance = 1e-10,
                                 .max_iterations = 400,
                                 .tuning = {.lbfgs = {.memory = {.pairs = 24}}}});
        CAPTURE(r);
        CHECK(r.stop == stop::gradient);
        CHECK(r.iterations < 200);
        CHECK(functions::distance(x, 1) <= 16e8 * 1e-10);
        CHECK(functions::largest_rise(r) == 0);
    }
}

TEST_CASE("lbfgs: badly scaled variables and values change nothing but the first search")
{
    for (const double scale : {1e-6, 1.0, 1e6})
        for (const double factor : {1e-6, 1.0, 1e6})
        {
            CAPTURE(scale);
            CAPTURE(factor);
            auto f = functions::rosenbrock(4, scale, factor);
            std::vector<double> x(4, 0.3 * scale);
            const auto r = minimize(f, x, {.gradient_tolerance = 1e-9});
            CHECK(r.stop == stop::gradient);
            CHECK(functions::distance(x, scale) <= 1e-5 * scale);
            CHECK(r.iterations < 60);
            CHECK(r.evaluations < 160);
        }
}

TEST_CASE("lbfgs: the two forms of the inverse Hessian give the same iterates to rounding")
{
    for (const int pairs : {1, 5, 20})
        for (const auto scale : {scaling::newest, scaling::largest})
            for (const int iterations : {1, 2, 5, 10, 20, 40})
            {
                CAPTURE(pairs);
                CAPTURE(iterations);
                auto f = functions::chain(50);
                std::vector<double> x = functions::noise(50), y = x;
                const params p{.line_search = line_search_method::strong_wolfe, // Brent's steps are noise from 1e-8 on
                               .gradient_tolerance = 0,
                               .max_iterations = iterations,
                               .tuning = {.lbfgs = {.memory = {.pairs = pairs, .scaling = scale}}}};
                const auto gram = minimize(f, x, p), loop = minimize_by_two_loops(f, y, p);
                CHECK(gram.evaluations == loop.evaluations);
                CHECK(functions::distance(x, y) < 1e-10);
            }
}

TEST_CASE("lbfgs: near convergence, where decreases are lost in rounding, gradients still fall")
{
    // Offsets of 1e4 leave 1e-12 of the value's digits to the decrease: without slopes, gradients would stick at 1e-6.
    for (const double offset : {0.0, 1e2, 1e4})
        for (const auto method : {line_search_method::hybrid, line_search_method::strong_wolfe})
        {
            CAPTURE(offset);
            CAPTURE(int(method));
            auto f = functions::quadratic(40, 100, offset);
            std::vector<double> x = functions::noise(40);
            const auto r = minimize(f, x, {.line_search = method, .gradient_tolerance = 1e-10});
            CHECK(r.stop == stop::gradient);
            CHECK(functions::distance(x, 1) <= 1e-7);
            CHECK(functions::largest_rise(r) <= 1e-14);
        }
}

TEST_CASE("lbfgs: at the limit of rounding it ends by itself, soon")
{
    for (const auto method : searches)
    {
        CAPTURE(int(method));
        auto f = functions::chain(60);
        std::vector<double> x = functions::noise(60);
        const auto r = minimize(f, x, {.line_search = method, .gradient_tolerance = 0});
        CAPTURE(r);
        CHECK((r.stop == stop::decrease || r.stop == stop::line_search || r.stop == stop::gradient));
        CHECK(r.gradient_norm < 1e-7);
        CHECK(r.evaluations < 1000);
    }
}

TEST_CASE("lbfgs: with the exact inverse Hessian as preconditioner a quadratic takes two steps")
{
    struct preconditioned : host_space
    {
        using host_space::host_space;
        using point = std::vector<double>;
        const host_space& space() const { return *this; }
        point make_point() const { return make(); }
        double value(const point& x) const
        {
            point g = x;
            return value_gradient(x, g);
        }
        double value_gradient(const point& x, point& g) const
        {
            double value = 0;
            for (std::size_t i = 0; i < x.size(); ++i)
            {
                g[i] = std::pow(10.0, double(i)) * (x[i] - 1);
                value += g[i] * (x[i] - 1) / 2;
            }
            return value;
        }
        void step(const point& x, double a, const point& d, point& out) const
        {
            for (std::size_t i = 0; i < x.size(); ++i) out[i] = x[i] + a * d[i];
        }
        void precondition(const point& v, point& out) const
        {
            for (std::size_t i = 0; i < v.size(); ++i) out[i] = 7 * v[i] / std::pow(10.0, double(i));
        }
    };
    static_assert(has_precondition<preconditioned>);

    for (const bool two_loops : {false, true})
        for (const auto which : {method::lbfgs, method::conjugate_gradient, method::gradient_descent})
        {
            preconditioned f(8);
            std::vector<double> x(8, 5.0);
            const params p{.method = which, .gradient_tolerance = 1e-9};
            const auto r = two_loops ? minimize_by_two_loops(f, x, p) : minimize(f, x, p);
            CHECK(r.stop == stop::gradient);
            CHECK(r.iterations <= 3);
            CHECK(functions::distance(x, 1) <= 1e-6);
        }
}

TEST_CASE("lbfgs: saddles and concave starts do not mislead it")
{
    // x^4/4 - x^2/2 + y^2/2: concave in x near 0, minima at (+-1, 0).
    host_objective f(2,
                     [](std::span<const double> x, std::span<double> g)
                     {
                         g[0] = x[0] * x[0] * x[0] - x[0];
                         g[1] = x[1];
                         return std::pow(x[0], 4) / 4 - x[0] * x[0] / 2 + x[1] * x[1] / 2;
                     });
    for (const auto method : searches)
    {
        std::vector<double> x{1e-6, 1e-5};
        const auto r =
            minimize(f, x, {.line_search = method, .gradient_tolerance = 1e-4, .tuning = {.first_length = 1e-6}});
        CHECK(converged(r.stop));
        CHECK(x[0] == doctest::Approx(1).epsilon(1e-6));
        if (method == line_search_method::backtracking) CHECK(r.skipped_pairs > 0); // short steps in the concave part
    }
}

namespace
{

/// A function with a barrier that x is on, off which only relax() leads.
template <class Function>
class walled : public Function
{
public:
    explicit walled(Function f) : Function(std::move(f)) {}

    double max_step(const std::vector<double>&, const std::vector<double>&) const
    {
        return behind_ ? std::numeric_limits<double>::infinity() : 0;
    }
    bool relax(std::vector<double>& x)
    {
        if (std::exchange(behind_, true)) return false;
        x[0] = 1;
        return true;
    }
    void linearize(const std::vector<double>&, bool) { ++linearized; }
    void hessian_product(const std::vector<double>& v, std::vector<double>& out) const { out = v; }
    void precondition(const std::vector<double>& v, std::vector<double>& out) const { out = v; }

    int linearized = 0;

private:
    bool behind_ = false;
};

} // namespace

TEST_CASE("lbfgs: what cuts every step short is relaxed, and the preconditioner follows the iterate")
{
    walled f(functions::quadratic(20, 100));
    std::vector<double> x(20, 0.0);
    const auto r = lbfgs(f, x);
    CHECK(r.stop == stop::gradient);
    CHECK(functions::distance(x, 1) < 1e-3);
    CHECK(f.linearized > 2);
}
