// SPDX-License-Identifier: MIT
#include "functions.hpp"

#include <taut/impl/core/solve/newton.hpp>
#include <taut/impl/core/solve/stop.hpp>

#include <doctest/doctest.h>

using namespace taut::solve;
using namespace taut::solve::impl;

namespace
{

using matrix = std::vector<std::vector<double>>;

/// Adds a Hessian to a function with a gradient; the preconditioner is the inverse of the stand-in's diagonal.
template <class Function, class Hessian>
class with_hessian : public Function
{
public:
    with_hessian(Function f, Hessian h) : Function(std::move(f)), h_(std::move(h)) {}

    void linearize(const std::vector<double>& x, bool exact)
    {
        A_ = h_(x, exact);
        stand_in_ = h_(x, false);
        exact_iterations += exact;
    }
    void hessian_product(const std::vector<double>& v, std::vector<double>& out) const
    {
        for (std::size_t i = 0; i < v.size(); ++i)
        {
            out[i] = 0;
            for (std::size_t j = 0; j < v.size(); ++j) out[i] += A_[i][j] * v[j];
        }
    }
    void precondition(const std::vector<double>& v, std::vector<double>& out) const
    {
        for (std::size_t i = 0; i < v.size(); ++i) out[i] = v[i] / stand_in_[i][i];
    }

    int exact_iterations = 0;

private:
    Hessian h_;
    matrix A_, stand_in_;
};

/// The Hessian of functions::rosenbrock, and its Gauss-Newton part.
matrix rosenbrock_hessian(const std::vector<double>& x, bool exact)
{
    const std::size_t n = x.size();
    matrix H(n, std::vector<double>(n, 0.0));
    for (std::size_t i = 0; i + 1 < n; ++i)
    {
        const double b = x[i + 1] - x[i] * x[i];
        H[i][i] += 2 + 800 * x[i] * x[i] - (exact ? 400 * b : 0);
        H[i + 1][i + 1] += 200;
        H[i][i + 1] -= 400 * x[i];
        H[i + 1][i] -= 400 * x[i];
    }
    return H;
}

/// Rosenbrock's function and 1: relative decreases then become small.
auto rosenbrock(std::size_t n)
{
    auto raised =
        host_objective(n,
                       [f = functions::rosenbrock(n), n](std::span<const double> x, std::span<double> g) mutable
                       {
                           std::vector<double> gradient(n);
                           const double value = f.value_gradient({x.begin(), x.end()}, gradient);
                           std::copy(gradient.begin(), gradient.end(), g.begin());
                           return value + 1;
                       });
    return with_hessian(std::move(raised), rosenbrock_hessian);
}

/// Residual norms of textbook conjugate gradients from 0 for A = diag(1..n), M = 1.
double model_after(const std::vector<double>& g, int steps)
{
    const std::size_t n = g.size();
    std::vector<double> d(n, 0.0), r(n), p(n);
    for (std::size_t i = 0; i < n; ++i) p[i] = r[i] = -g[i];
    for (int k = 0; k < steps; ++k)
    {
        double rr = 0, pAp = 0, new_rr = 0;
        for (std::size_t i = 0; i < n; ++i) rr += r[i] * r[i], pAp += p[i] * double(i + 1) * p[i];
        for (std::size_t i = 0; i < n; ++i)
        {
            d[i] += rr / pAp * p[i];
            r[i] -= rr / pAp * double(i + 1) * p[i];
            new_rr += r[i] * r[i];
        }
        for (std::size_t i = 0; i < n; ++i) p[i] = r[i] + new_rr / rr * p[i];
    }
    double model = 0;
    for (std::size_t i = 0; i < n; ++i) model -= g[i] * d[i] + double(i + 1) * d[i] * d[i] / 2;
    return model;
}

} // namespace

TEST_CASE("pcg: any block size reaches what conjugate gradients reach after as many steps")
{
    const std::size_t n = 40;
    host_space space(n);
    std::vector<double> g(n), d(n);
    for (std::size_t i = 0; i < n; ++i) g[i] = std::sin(double(7 * i + 1));
    const auto A = [](const std::vector<double>& v, std::vector<double>& out)
    {
        for (std::size_t i = 0; i < v.size(); ++i) out[i] = double(i + 1) * v[i];
    };
    const auto M = [](const std::vector<double>& v, std::vector<double>& out) { out = v; };

    for (const int block : {1, 2, 3})
        for (const int steps : {block, 2 * block})
        {
            pcg solver(space, pcg_params{.max_steps = steps, .block = block, .gain = 1e-12});
            const auto result = solver.solve(g, A, M, d);
            CAPTURE(block);
            CAPTURE(steps);
            CHECK(result.steps == steps);
            CHECK(result.decrease == doctest::Approx(model_after(g, steps)));
            CHECK(result.gradient_squared == doctest::Approx(space.dot(g, g)));
            CHECK(result.slope == doctest::Approx(space.dot(g, d)));
        }
}

TEST_CASE("pcg: a system like the last one is solved with one look at the result")
{
    const std::size_t n = 40;
    host_space space(n);
    std::vector<double> g(n, 1.0), d(n);
    const auto A = [](const std::vector<double>& v, std::vector<double>& out)
    {
        for (std::size_t i = 0; i < v.size(); ++i) out[i] = (0.2 + 0.8 * double(i) / double(v.size())) * v[i];
    };
    const auto M = [](const std::vector<double>& v, std::vector<double>& out) { out = v; };
    pcg solver(space, {.gain = 1e-3});
    const auto first = solver.solve(g, A, M, d);
    const auto second = solver.solve(g, A, M, d);
    CHECK(first.looks > 1);
    CHECK(second.looks == 1);
    CHECK(second.decrease >= first.decrease * (1 - 1e-3));
}

TEST_CASE("pcg: an exact preconditioner needs one step and stops by itself")
{
    const std::size_t n = 10;
    host_space space(n);
    std::vector<double> g(n, 1.0), d(n);
    const auto A = [](const std::vector<double>& v, std::vector<double>& out)
    {
        for (std::size_t i = 0; i < v.size(); ++i) out[i] = double(i + 1) * v[i];
    };
    const auto M = [](const std::vector<double>& v, std::vector<double>& out)
    {
        for (std::size_t i = 0; i < v.size(); ++i) out[i] = v[i] / double(i + 1);
    };
    const auto result = pcg(space, {}).solve(g, A, M, d);
    CHECK(result.steps == 1);
    for (std::size_t i = 0; i < n; ++i) CHECK(d[i] == doctest::Approx(-1 / double(i + 1)));
}

TEST_CASE("pcg: negative curvature ends the search with a direction of descent")
{
    host_space space(2);
    const auto M = [](const std::vector<double>& v, std::vector<double>& out) { out = v; };
    std::vector<double> d(2);
    SUBCASE("at once")
    {
        const auto A = [](const std::vector<double>& v, std::vector<double>& out) { out = {-v[0], -2 * v[1]}; };
        const auto result = pcg(space, {}).solve({1.0, 2.0}, A, M, d);
        CHECK(result.steps == 1);
        CHECK(d == std::vector<double>{-8.0, -16.0}); // the way gets steeper
        CHECK(result.slope == doctest::Approx(-40));
    }
    SUBCASE("in the second step")
    {
        const auto A = [](const std::vector<double>& v, std::vector<double>& out) { out = {4 * v[0], -v[1]}; };
        const auto result = pcg(space, {}).solve({1.0, 1.0}, A, M, d);
        CHECK(result.steps == 1);
        CHECK(result.slope < 0);
    }
}

TEST_CASE("pcg: a direction of negative curvature becomes half of the slope")
{
    const std::size_t n = 40;
    host_space space(n);
    std::vector<double> g(n), d(n);
    for (std::size_t i = 0; i < n; ++i) g[i] = std::sin(double(7 * i + 1));
    const auto M = [](const std::vector<double>& v, std::vector<double>& out) { out = v; };
    for (const double least : {-0.01, -1.0, -30.0})
        for (const int block : {1, 2, 6})
        {
            const auto A = [least](const std::vector<double>& v, std::vector<double>& out)
            {
                for (std::size_t i = 0; i < v.size(); ++i) out[i] = (i == 5 ? least : double(i + 1)) * v[i];
            };
            pcg solver(space, pcg_params{.max_steps = 40, .block = block, .gain = 1e-12});
            const auto result = solver.solve(g, A, M, d);
            std::vector<double> Ad(n);
            A(d, Ad);
            CAPTURE(least);
            CAPTURE(block);
            CHECK(result.negative);
            CHECK(result.slope == doctest::Approx(space.dot(g, d)));
            CHECK(result.slope == doctest::Approx(-4 * result.decrease));
            // Along it the model falls further: n'A n < 0, and n is conjugate to what was found before.
            CHECK(space.dot(d, Ad) < 2 * result.decrease);

            // Where the model falls by no more than the noise of values, it is left.
            const auto wary = solver.solve(
                g, A, M, d, [] { return true; }, 0, nullptr, 1e6);
            CHECK_FALSE(wary.negative);
            CHECK(wary.decrease > 0);
            CHECK(wary.slope == doctest::Approx(-2 * wary.decrease));
            CHECK(wary.slope == doctest::Approx(space.dot(g, d)));
        }
}

TEST_CASE("pcg: what is known of the answer takes a product and no preconditioning")
{
    // One soft direction, far from the rest of the spectrum, that M does not know of.
    const std::size_t n = 40;
    host_space space(n);
    std::vector<double> g(n), d(n), soft(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) g[i] = std::sin(double(7 * i + 1));
    soft[0] = 2;
    const auto A = [](const std::vector<double>& v, std::vector<double>& out)
    {
        for (std::size_t i = 0; i < v.size(); ++i) out[i] = (i == 0 ? 1e-4 : 1 + 0.1 * double(i)) * v[i];
    };
    int preconditionings = 0;
    const auto M = [&](const std::vector<double>& v, std::vector<double>& out)
    {
        out = v;
        ++preconditionings;
    };
    const auto decrease = [&](const std::vector<double>* of, int block)
    {
        preconditionings = 0;
        pcg solver(space, pcg_params{.max_steps = 4, .block = block, .gain = 1e-12});
        const auto result = solver.solve(
            g, A, M, d, [] { return true; }, 0, of);
        CAPTURE(block);
        CHECK(result.steps == preconditionings + (of ? 1 : 0));
        CHECK(result.steps <= 4);
        CHECK(result.slope == doctest::Approx(space.dot(g, d)));
        CHECK_FALSE(result.negative);
        return result.decrease;
    };
    for (const int block : {1, 3, 6})
    {
        const double without = decrease(nullptr, block);
        CHECK(decrease(&soft, block) > 10 * without);
        CHECK(preconditionings == 3);
    }
}

TEST_CASE("pcg: what is known already ends nothing, and a negative curvature of it is taken")
{
    const std::size_t n = 40;
    host_space space(n);
    std::vector<double> g(n, 1.0), d(n);
    const auto M = [](const std::vector<double>& v, std::vector<double>& out) { out = v; };
    const auto solve = [&](double first, const std::vector<double>& known)
    {
        const auto A = [first](const std::vector<double>& v, std::vector<double>& out)
        {
            for (std::size_t i = 0; i < v.size(); ++i) out[i] = (i == 0 ? first : double(i + 1)) * v[i];
        };
        pcg solver(space, pcg_params{.max_steps = 20, .block = 2, .gain = 1e-12});
        return solver.solve(
            g, A, M, d, [] { return true; }, 0, &known);
    };
    // The gradient itself is the first vector of the space, and zero is in any.
    for (const double factor : {-3.0, 0.0})
    {
        const auto result = solve(1, std::vector<double>(n, factor));
        CHECK(result.steps == 20);
        CHECK(result.decrease == doctest::Approx(model_after(g, 20)));
    }
    std::vector<double> ridge(n, 0.0);
    ridge[0] = 1;
    const auto result = solve(-0.01, ridge);
    CHECK(result.negative);
    CHECK(result.slope == doctest::Approx(-4 * result.decrease));
    CHECK(result.slope == doctest::Approx(space.dot(g, d)));
}

TEST_CASE("newton: leaves a region where its Hessian is indefinite in few iterations")
{
    // Wells in every other coordinate, from near their ridges; the stand-in is stiff across them, as projected Hessians
    // are where a part of a map turns.
    const std::size_t n = 40;
    const auto curved = [](std::size_t i) { return i % 2 == 1; };
    auto f = with_hessian(host_objective(n,
                                         [&](std::span<const double> x, std::span<double> g)
                                         {
                                             double value = 100;
                                             for (std::size_t i = 0; i < n; ++i)
                                             {
                                                 const double y = x[i] * x[i];
                                                 value += curved(i) ? y * y / 4 - y / 2 : double(i + 1) * y / 2;
                                                 g[i] = curved(i) ? x[i] * y - x[i] : double(i + 1) * x[i];
                                             }
                                             return value;
                                         }),
                          [&](const std::vector<double>& x, bool exact)
                          {
                              matrix H(n, std::vector<double>(n, 0.0));
                              for (std::size_t i = 0; i < n; ++i)
                                  H[i][i] = !curved(i) ? double(i + 1) : exact ? 3 * x[i] * x[i] - 1 : 30;
                              return H;
                          });
    std::vector<double> x(n);
    for (std::size_t i = 0; i < n; ++i) x[i] = curved(i) ? 0.01 * double(1 + i % 7) : 1.0;
    const auto r = newton(f, x, {}, {.stopping = {.gradient_tolerance = 1e-10, .max_iterations = 100}});
    CHECK(r.stop == stop::gradient);
    CHECK(r.iterations <= 60); // 96 with neither conjugate directions nor negative curvature
    for (std::size_t i = 0; i < n; ++i) CHECK(std::abs(x[i]) == doctest::Approx(curved(i) ? 1.0 : 0.0));
}

TEST_CASE("newton: a stand-in that is much too stiff takes few iterations, too")
{
    // Its directions are those of steepest descent with a condition of 50 in its metric.
    const std::size_t n = 40;
    const auto curvature = [](std::size_t i, bool exact)
    { return double(i + 1) * (exact ? 1 / double(1 + i * 5 / 4) : 1); };
    auto f = with_hessian(host_objective(n,
                                         [&](std::span<const double> x, std::span<double> g)
                                         {
                                             double value = 1;
                                             for (std::size_t i = 0; i < n; ++i)
                                             {
                                                 g[i] = curvature(i, true) * x[i];
                                                 value += g[i] * x[i] / 2;
                                             }
                                             return value;
                                         }),
                          [&](const std::vector<double>&, bool)
                          {
                              matrix H(n, std::vector<double>(n, 0.0));
                              for (std::size_t i = 0; i < n; ++i) H[i][i] = curvature(i, false);
                              return H;
                          });
    std::vector<double> x(n, 1.0);
    const auto r = newton(f, x, {.exact_below = 0}, {.stopping = {.gradient_tolerance = 1e-8, .max_iterations = 1000}});
    CHECK(r.stop == stop::gradient);
    CHECK(r.iterations <= 250); // 818 with steps of at most 1 in directions that are not conjugate
    for (std::size_t k = 1; k < r.history.size(); ++k) CHECK(r.history[k].step <= 4);
}

TEST_CASE("newton: where full steps succeed, systems may take more steps than at first")
{
    // A chain of springs, held at one end and drawn at the other: conjugate gradients need a step a spring, and what is
    // begun anew every four steps crawls.
    constexpr std::size_t n = 60;
    auto chain = host_objective(n,
                                [](std::span<const double> x, std::span<double> g)
                                {
                                    double f = 1 - x[n - 1];
                                    for (std::size_t i = 0; i < n; ++i) g[i] = 0;
                                    g[n - 1] = -1;
                                    for (std::size_t i = 0; i < n; ++i)
                                    {
                                        const double d = x[i] - (i > 0 ? x[i - 1] : 0);
                                        f += 0.5 * d * d;
                                        g[i] += d;
                                        if (i > 0) g[i - 1] -= d;
                                    }
                                    return f + 100;
                                });
    auto f = with_hessian(std::move(chain),
                          [](const std::vector<double>&, bool)
                          {
                              matrix H(n, std::vector<double>(n, 0.0));
                              for (std::size_t i = 0; i < n; ++i)
                              {
                                  H[i][i] = i + 1 < n ? 2 : 1;
                                  if (i > 0) H[i][i - 1] = H[i - 1][i] = -1;
                              }
                              return H;
                          });
    std::vector<double> x(n, 0.0);
    const auto r = newton(f, x, {.pcg = {.max_steps = 4, .gain = 1e-6}, .exact_below = 0.9},
                          {.stopping = {.gradient_tolerance = 1e-6, .max_iterations = 1000}});
    CHECK(converged(r.stop));
    CHECK(r.iterations <= 40); // hundreds with four steps each
    CHECK(x.back() == doctest::Approx(double(n)).epsilon(1e-3));
}

TEST_CASE("newton: finds the minimum of Rosenbrock's function in few iterations")
{
    for (const std::size_t n : {2, 10, 30})
    {
        auto f = rosenbrock(n);
        std::vector<double> x = functions::rosenbrock_start(n);
        if (n > 2) // away from the second, local minimum
            for (double& v : x) v = 0.5;
        const auto r = newton(f, x, {.pcg = {.max_steps = 40, .gain = 0.01}},
                              {.stopping = {.gradient_tolerance = 1e-10, .max_iterations = 200}});
        CAPTURE(n);
        CHECK(r.stop == stop::gradient);
        CHECK(r.iterations <= 80);
        CHECK(f.exact_iterations > 0);
        for (const double v : x) CHECK(v == doctest::Approx(1));
        for (std::size_t k = 1; k < r.history.size(); ++k) CHECK(r.history[k].value <= r.history[k - 1].value);
        CHECK(r.history.back().value == r.value);
    }
}

namespace
{

/// Rosenbrock's function, of which a part may be minimised by itself: here all of it.
struct with_elimination : decltype(rosenbrock(2))
{
    explicit with_elimination(std::size_t n) : decltype(rosenbrock(2))(rosenbrock(n)) {}

    bool eliminate(std::vector<double>& x, const std::vector<double>& unexpected, const std::function<bool()>& proceed)
    {
        ++asked;
        longest = std::max(longest, std::abs(*std::max_element(unexpected.begin(), unexpected.end())));
        if (!moves || !proceed()) return false;
        std::fill(x.begin(), x.end(), 1.0);
        return true;
    }

    bool moves = true;
    int asked = 0;
    double longest = 0;
};

} // namespace

TEST_CASE("newton: goes on from where parts were minimised by themselves")
{
    const std::size_t n = 8;
    const descent_params common{.stopping = {.gradient_tolerance = 1e-10, .max_iterations = 200}};
    const auto run = [&](with_elimination& f, newton_params how, std::vector<double> x)
    { return newton(f, x, how, common); };
    const std::vector<double> x(n, -1.2);
    with_elimination f(n);
    const auto found = run(f, {.eliminate_from = 4, .eliminate_below = 1, .eliminate_above = 1e-3}, x);
    CHECK(found.iterations == 4);
    CHECK(found.eliminations == 1);
    CHECK(found.stop == stop::gradient);
    CHECK(found.value == doctest::Approx(1));
    CHECK(f.longest > 0);

    with_elimination still(n), never(n);
    still.moves = false;
    const auto in_vain = run(still, {.eliminate_from = 4, .eliminate_below = 1, .eliminate_above = 1e-3}, x);
    const auto without = run(never, {.eliminate_below = 0}, x);
    CHECK(still.asked > 1);
    CHECK(never.asked == 0);
    CHECK(in_vain.eliminations == 0);
    CHECK(in_vain.iterations == without.iterations);
    CHECK(in_vain.value == without.value);
}

TEST_CASE("newton: a quadratic takes one iteration for each space of directions")
{
    const std::size_t n = 12;
    auto f = with_hessian(functions::quadratic(n, 1e4),
                          [](const std::vector<double>& x, bool)
                          {
                              matrix H(x.size(), std::vector<double>(x.size(), 0.0));
                              for (std::size_t i = 0; i < x.size(); ++i)
                                  H[i][i] = std::pow(1e4, double(i) / double(x.size() - 1));
                              return H;
                          });
    std::vector<double> x(n, 0.0);
    const auto r = newton(f, x, {}, {.stopping = {.gradient_tolerance = 1e-12}});
    CHECK(r.iterations == 1); // the preconditioner is the inverse
    CHECK(r.stop == stop::gradient);
}

TEST_CASE("newton: limits, the observer and bad parameters end a run as in the other methods")
{
    auto f = rosenbrock(2);
    auto x = functions::rosenbrock_start(2);
    CHECK(newton(f, x, {}, {.stopping = {.max_iterations = 3}}).stop == stop::iterations);
    CHECK(newton(f, x, {}, {}, {.observer = [](const taut::progress& p) { return p.iteration < 2; }}).stop ==
          stop::user);
    std::vector<double> bad{std::numeric_limits<double>::infinity(), 0.0};
    CHECK(newton(f, bad).stop == stop::not_finite_start);
    CHECK_THROWS_AS(newton(f, x, {}, {.line_search = {.tuning = {.wolfe = {.sufficient_decrease = 0.5}}}}),
                    taut::parameter_error);
    CHECK_THROWS_AS(newton(f, x, {.pcg = {.block = 9}}), taut::parameter_error);
    CHECK_THROWS_AS(newton(f, x, {.exact_below = 1}), taut::parameter_error);
}

TEST_CASE("newton: of a line search it takes what it has a use for, and refuses the rest")
{
    auto f = with_hessian(host_objective(1,
                                         [](std::span<const double> x, std::span<double> g)
                                         {
                                             g[0] = 4 * std::pow(x[0], 3);
                                             return 1 + std::pow(x[0], 4);
                                         }),
                          [](const std::vector<double>& x, bool) { return matrix{{4 * x[0] * x[0]}}; });
    const auto run = [&](const params& p)
    {
        std::vector<double> x{0.5};
        return minimize(f, x, p);
    };
    // The full step is the best one, and gains a quarter of what the slope promises.
    CHECK(run({}).history[1].step == 1);
    CHECK(run({.tuning = {.line = {.wolfe = {.sufficient_decrease = 0.45}}}}).history[1].step == doctest::Approx(0.5));
    CHECK(run({.tuning = {.line = {.barrier_fraction = 0.5, .rounding = 1e-13}}}).history[1].step == 1); // no barrier
    for (const auto m : {method::automatic, method::newton})
    {
        CHECK_THROWS_AS(run({.method = m, .line_search = line_search_method::strong_wolfe}), taut::parameter_error);
        CHECK_THROWS_AS(run({.method = m, .tuning = {.line = {.wolfe = {.curvature = 0.5}}}}), taut::parameter_error);
        CHECK_THROWS_AS(run({.method = m, .tuning = {.first_length = 2}}), taut::parameter_error);
    }
    CHECK_NOTHROW(run({.method = method::lbfgs, .tuning = {.line = {.shrink = 0.4}}}));
}

TEST_CASE("newton: whatever ends a run, the report is of the point that it leaves")
{
    for (int questions = 1; questions < 40; ++questions)
    {
        auto f = rosenbrock(4);
        std::vector<double> x(4, 0.5), g(4);
        int asked = 0;
        const auto r = newton(f, x, {}, {}, {.observer = [&](const taut::progress&) { return ++asked < questions; }});
        CAPTURE(questions);
        CHECK((r.stop == stop::user || r.stop == stop::gradient));
        CHECK(asked <= questions);
        CHECK(f.value_gradient(x, g) == r.value);
        CHECK(r.history.size() == static_cast<std::size_t>(r.iterations) + 1);
        CHECK(r.history.back().value == r.value);
        CHECK(r.history.back().gradient == r.gradient_norm);
    }
}

TEST_CASE("newton: ends where the Hessian promises next to nothing, though rounding keeps a steep gradient long")
{
    constexpr double steep = 1e10, noise = 1e-3;
    int calls = 0;
    auto f = with_hessian(host_objective(2,
                                         [&](std::span<const double> x, std::span<double> g)
                                         {
                                             g[0] = x[0];
                                             g[1] = steep * x[1] + (++calls % 2 == 0 ? noise : -noise);
                                             return 1 + (x[0] * x[0] + steep * x[1] * x[1]) / 2;
                                         }),
                          [](const std::vector<double>&, bool) {
                              return matrix{{1, 0}, {0, steep}};
                          });
    std::vector<double> x{10, 0};
    const auto r = minimize(f, x, {.method = method::newton});
    CHECK(r.stop == stop::decrement);
    CHECK(r.gradient_norm > 1e-6);
    CHECK(r.value - 1 <= 1e-8);
    CHECK(r.iterations <= 5);
}
