// SPDX-License-Identifier: MIT
#include "functions.hpp"

#include <doctest/doctest.h>

using namespace taut::solve;
using namespace taut::solve::impl;

namespace
{

/// sum of c_i x_i + 1/x_i over x > 0: minimum at 1/sqrt(c_i), barrier at 0. Every point ever evaluated is checked.
template <bool batched>
class reciprocal
{
public:
    using point = std::vector<double>;

    explicit reciprocal(std::vector<double> c) : c_(std::move(c)), space_(c_.size()) {}

    const host_space& space() const { return space_; }
    point make_point() const { return space_.make(); }
    void copy(const point& x, point& y) const { y = x; }

    double value(const point& x)
    {
        double sum = 0;
        for (std::size_t i = 0; i < x.size(); ++i)
        {
            if (x[i] <= 0) ++outside;
            sum += x[i] > 0 ? c_[i] * x[i] + 1 / x[i] : std::numeric_limits<double>::quiet_NaN();
        }
        return sum;
    }

    double value_gradient(const point& x, point& g)
    {
        for (std::size_t i = 0; i < x.size(); ++i) g[i] = c_[i] - 1 / (x[i] * x[i]);
        return value(x);
    }

    void step(const point& x, double a, const point& d, point& out) const
    {
        for (std::size_t i = 0; i < x.size(); ++i) out[i] = x[i] + a * d[i];
    }

    double max_step(const point& x, const point& d)
    {
        double first = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < x.size(); ++i)
            if (d[i] < 0) first = std::min(first, -x[i] / d[i]);
        return first;
    }

    void values(const point& x, const point& d, std::span<const double> a, std::span<double> out) requires batched
    {
        ++passes;
        point trial = x;
        for (std::size_t i = 0; i < a.size(); ++i)
        {
            step(x, a[i], d, trial);
            out[i] = value(trial);
        }
    }

    int outside = 0, passes = 0;

private:
    std::vector<double> c_;
    host_space space_;
};

static_assert(full_objective<reciprocal<true>>::batches && !full_objective<reciprocal<false>>::batches);

} // namespace

TEST_CASE_TEMPLATE("barrier: no trial ever leaves the domain, and the minimum near it is found", Objective,
                   reciprocal<false>, reciprocal<true>)
{
    for (const auto method :
         {line_search_method::hybrid, line_search_method::strong_wolfe, line_search_method::backtracking})
        for (const double fraction : {0.9, 0.99})
        {
            Objective f({1, 100, 1e4, 1e6});
            std::vector<double> x{5, 5, 5, 5};
            const auto r = minimize(f, x,
                                    {.line_search = method,
                                     .gradient_tolerance = 1e-9,
                                     .tuning = {.line = {.barrier_fraction = fraction}}});
            CAPTURE(r);
            CHECK(r.stop == stop::gradient);
            CHECK(f.outside == 0);
            CHECK(x[0] == doctest::Approx(1));
            CHECK(x[3] == doctest::Approx(1e-3));
            CHECK(functions::largest_rise(r) <= 1e-14);
            int capped = 0;
            for (const auto& entry : r.history) capped += entry.capped;
            CHECK(capped > 0); // the way from 5 to 0.001 runs along the barrier
        }
}

TEST_CASE("barrier: batched trial steps are used where the objective has them")
{
    reciprocal<true> f({1, 100, 1e4});
    std::vector<double> x{1e-3, 5, 1e-4};
    const auto r = minimize(f, x, {.tuning = {.first_length = 1e-8}}); // far too short: a ladder of longer steps
    CHECK(r.stop == stop::gradient);
    CHECK(f.passes > 0);
    CHECK(f.outside == 0);
}

TEST_CASE("barrier: a minimum on the barrier itself ends with stop::barrier, inside the domain")
{
    // The value falls all the way to x = 0, where max_step ends: every step is cut.
    struct : host_space
    {
        using host_space::host_space;
        using point = std::vector<double>;
        const host_space& space() const { return *this; }
        point make_point() const { return make(); }
        double value(const point& x) const { return x[0] > 0 ? 1 + x[0] : std::numeric_limits<double>::infinity(); }
        double value_gradient(const point& x, point& g) const
        {
            g[0] = 1;
            return value(x);
        }
        void step(const point& x, double a, const point& d, point& out) const { out[0] = x[0] + a * d[0]; }
        double max_step(const point& x, const point& d) const { return -x[0] / d[0]; }
    } f(1);
    std::vector<double> x{3};
    const auto r = minimize(f, x, {.decrease_tolerance = 1e-12});
    CAPTURE(r);
    CHECK((r.stop == stop::barrier || r.stop == stop::line_search));
    CHECK(x[0] > 0);
    CHECK(x[0] < 1e-10);
    CHECK(functions::largest_rise(r) == 0);
}

TEST_CASE("barrier: NaN islands and a domain without a max_step are searched around")
{
    // A bowl around (2, 0) that is NaN in a disk between the start and the minimum, and infinite for y > 3.
    host_objective f(2,
                     [](std::span<const double> x, std::span<double> g)
                     {
                         g[0] = 2 * (x[0] - 2);
                         g[1] = 20 * x[1];
                         if (std::hypot(x[0] - 1, x[1] - 0.4) < 0.3) return std::numeric_limits<double>::quiet_NaN();
                         if (x[1] > 3) return std::numeric_limits<double>::infinity();
                         return std::pow(x[0] - 2, 2) + 10 * x[1] * x[1];
                     });
    for (const auto method :
         {line_search_method::hybrid, line_search_method::strong_wolfe, line_search_method::backtracking})
    {
        CAPTURE(int(method));
        std::vector<double> x{-3, 2.9};
        const auto r = minimize(f, x, {.line_search = method});
        CHECK(r.stop == stop::gradient);
        CHECK(x[0] == doctest::Approx(2).epsilon(1e-4));
        for (const auto& entry : r.history) CHECK(std::isfinite(entry.value));
    }
}

TEST_CASE("barrier: infinite gradients at finite values are refused")
{
    // sqrt(x) + x^2 style cusp: at x <= 0 the value is finite but the gradient is not.
    host_objective f(1,
                     [](std::span<const double> x, std::span<double> g)
                     {
                         g[0] = x[0] > 0 ? 2 * (x[0] - 1e-3) : std::numeric_limits<double>::infinity();
                         return x[0] > 0 ? std::pow(x[0] - 1e-3, 2) : -1.0;
                     });
    std::vector<double> x{1};
    const auto r = minimize(f, x, {.tuning = {.first_length = 100}});
    CHECK(std::isfinite(r.gradient_norm));
    CHECK(x[0] > 0);
}
