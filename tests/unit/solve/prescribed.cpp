// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include <taut/impl/core/solve/prescribed.hpp>
#include <taut/solve.hpp>

using namespace taut::solve;
using namespace taut::solve::impl;

namespace
{

/// Beads on a line, x_0 < x_1 < ...: each gap l between neighbours has the energy l + 1 / l - 2, which is 0 at rest,
/// and none may close. The first one is tied to 0, the last one is prescribed.
class beads : public host_objective<double (*)(std::span<const double>, std::span<double>)>
{
public:
    beads(std::size_t n, double wanted) : host_objective(n, sum), n_(n), wanted_(wanted) {}

    double max_step(const std::vector<double>& x, const std::vector<double>& d) const
    {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i + 1 < n_; ++i)
            if (d[i + 1] < d[i]) least = std::min(least, (x[i + 1] - x[i]) / (d[i] - d[i + 1]));
        return least;
    }
    void linearize(const std::vector<double>& x, bool)
    {
        stiffness_.clear();
        for (std::size_t i = 0; i + 1 < n_; ++i) stiffness_.push_back(2 / std::pow(x[i + 1] - x[i], 3));
    }
    model_change linearize_towards(const std::vector<double>& x, double share, std::vector<double>& d,
                                   std::vector<double>& g)
    {
        linearize(x, false);
        const double value = sum(x, g), force = g.back();
        d.assign(n_, 0);
        d.back() = share * (wanted_ - x.back());
        std::vector<double> product(n_);
        multiply(d, product);
        for (std::size_t i = 0; i < n_; ++i) g[i] += product[i];
        g.back() = 0;
        return {value, (force + product.back() / 2) * d.back()};
    }
    void hessian_product(const std::vector<double>& v, std::vector<double>& out) const
    {
        multiply(v, out);
        out.back() = 0;
    }
    void precondition(const std::vector<double>& v, std::vector<double>& out) const
    {
        for (std::size_t i = 0; i + 1 < n_; ++i) out[i] = v[i] / (stiffness_[i] + (i > 0 ? stiffness_[i - 1] : 1));
        out.back() = 0;
    }
    void put(std::vector<double>& x) const { x.back() = wanted_; }
    double value_scale() const { return 2 * double(n_ - 1); }

    static std::vector<double> evenly(std::size_t n, double end)
    {
        std::vector<double> x(n);
        for (std::size_t i = 0; i < n; ++i) x[i] = end * double(i) / double(n - 1);
        return x;
    }

private:
    static double sum(std::span<const double> x, std::span<double> g)
    {
        double value = x[0] * x[0] / 2;
        for (double& c : g) c = 0;
        g[0] = x[0];
        for (std::size_t i = 0; i + 1 < x.size(); ++i)
        {
            const double l = x[i + 1] - x[i], force = 1 - 1 / (l * l);
            value += l > 0 ? l + 1 / l - 2 : std::numeric_limits<double>::infinity();
            g[i] -= force;
            g[i + 1] += force;
        }
        return value;
    }
    void multiply(const std::vector<double>& v, std::vector<double>& out) const
    {
        out.assign(n_, 0);
        out[0] = v[0];
        for (std::size_t i = 0; i + 1 < n_; ++i)
        {
            const double f = stiffness_[i] * (v[i + 1] - v[i]);
            out[i] -= f;
            out[i + 1] += f;
        }
    }

    std::size_t n_;
    double wanted_;
    std::vector<double> stiffness_;
};

/// Beads of which no one knows in advance how far they may go: what passes another one has an energy of infinity.
struct blind_beads : beads
{
    using beads::beads;
    double max_step(const std::vector<double>&, const std::vector<double>&) const
    {
        return std::numeric_limits<double>::infinity();
    }
};

const prescribed_params thorough{.pcg = {.gain = 1e-6}};
const auto on = [](const prescribed_report&) { return true; };

} // namespace

TEST_CASE("prescribed: from rest, where f is 0, a coordinate that is near arrives in one step, to the last bit")
{
    beads f(8, 7.3);
    auto x = beads::evenly(8, 7);
    prescribed_newton<beads> steps(f, thorough);
    const auto r = steps.run(x, 0.3, on);
    CHECK(r.arrived);
    CHECK(r.left == 0);
    CHECK(r.iterations == 1);
    CHECK(x.back() == 7.3);
    for (std::size_t i = 0; i + 1 < x.size(); ++i) CHECK(x[i + 1] > x[i]);
    CHECK(x[6] > 6.05);
    CHECK(r.value == doctest::Approx(f.value(x)).epsilon(1e-12));
}

TEST_CASE("prescribed: where it lies beyond all others, these are driven on and none is passed")
{
    beads f(8, -2);
    auto x = beads::evenly(8, 7);
    prescribed_newton<beads> steps(f, thorough);
    double last = 9;
    const auto r = steps.run(x, last,
                             [&](const prescribed_report& at)
                             {
                                 CHECK(at.left <= last);
                                 CHECK(at.left == doctest::Approx(x.back() + 2).epsilon(1e-9));
                                 for (std::size_t i = 0; i + 1 < x.size(); ++i) CHECK(x[i + 1] > x[i]);
                                 last = at.left;
                                 return true;
                             });
    CHECK(r.arrived);
    CHECK(r.iterations < 60);
    CHECK(x.back() == -2);
}

TEST_CASE("prescribed: where an eighth of a step is too long, shorter ones are tried")
{
    blind_beads f(8, -100);
    auto x = beads::evenly(8, 7);
    prescribed_newton<blind_beads> steps(f, thorough);
    const auto first = steps.run(x, 107, [](const prescribed_report&) { return false; });
    CHECK(first.iterations == 1);
    CHECK(first.left < 107);
    CHECK(first.left == doctest::Approx(x.back() + 100));
    for (std::size_t i = 0; i + 1 < x.size(); ++i) CHECK(x[i + 1] > x[i]);
}

TEST_CASE("prescribed: it ends where it is told to, says what is left, and goes on from there")
{
    beads f(8, -2);
    auto x = beads::evenly(8, 7);
    prescribed_newton<beads> steps(f, thorough);
    const auto first = steps.run(x, 9, [](const prescribed_report& at) { return at.iterations < 3; });
    CHECK(!first.arrived);
    CHECK(!first.crawling);
    CHECK(first.iterations == 3);
    CHECK(first.left == doctest::Approx(x.back() + 2));
    CHECK(first.left < 9);
    CHECK(steps.run(x, first.left, on).arrived);
}

TEST_CASE("prescribed: parameters out of range are refused by name")
{
    beads f(4, 1);
    CHECK_THROWS_AS((prescribed_newton<beads>(f, {.barrier_fraction = 1})), taut::parameter_error);
    CHECK_THROWS_AS((prescribed_newton<beads>(f, {.most_rise = 0})), taut::parameter_error);
    CHECK_THROWS_AS((prescribed_newton<beads>(f, {.pcg = {.gain = 2}})), taut::parameter_error);
}
