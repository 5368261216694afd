// SPDX-License-Identifier: MIT
#include "functions.hpp"

#include <doctest/doctest.h>

#include "support/two_loop.hpp"
#include <memory>

using namespace taut::solve;
using namespace taut::solve::impl;

namespace
{

/// A space that behaves like a device: vectors are movable handles of float data, and every product is a host wait.
class device_space
{
public:
    struct vector
    {
        std::unique_ptr<std::vector<float>> data;
    };

    explicit device_space(std::size_t n) : host_(n) {}

    vector make() const { return {std::make_unique<std::vector<float>>(host_.make())}; }
    void copy(const vector& x, vector& y) const { host_.copy(*x.data, *y.data); }
    void axpby(double a, const vector& x, double b, vector& y) const { host_.axpby(a, *x.data, b, *y.data); }

    double dot(const vector& x, const vector& y) const
    {
        ++waits;
        return host_.dot(*x.data, *y.data);
    }

    void multi_dot(std::span<const vector* const> left, std::span<const vector* const> right,
                   std::span<double> out) const
    {
        ++waits;
        for (std::size_t i = 0; i < left.size(); ++i)
            for (std::size_t j = 0; j < right.size(); ++j)
                out[i * right.size() + j] = host_.dot(*left[i]->data, *right[j]->data);
    }

    void linear_combination(std::span<const double> a, std::span<const vector* const> x, vector& out) const
    {
        std::vector<const std::vector<float>*> terms;
        for (const vector* v : x)
        {
            CHECK(v != &out); // the contract: no aliasing
            terms.push_back(v->data.get());
        }
        host_.linear_combination(a, terms, *out.data);
    }

    mutable int waits = 0;

private:
    basic_host_space<float> host_;
};

static_assert(vector_space<device_space> && vector_space<const device_space>);

/// The chain of springs with points in double and vectors in float, a max_step and batched values; everything that
/// returns a number waits.
class device_objective
{
public:
    struct point
    {
        std::unique_ptr<std::vector<double>> data;
    };
    using vector = device_space::vector;

    explicit device_objective(std::size_t n) : n_(n), host_(functions::chain(n)), space_(n) {}

    device_space& space() { return space_; }
    point make_point() const { return {std::make_unique<std::vector<double>>(n_)}; }
    void copy(const point& x, point& y) const { *y.data = *x.data; }

    double value(const point& x)
    {
        ++space_.waits;
        return host_.value(*x.data);
    }

    double value_gradient(const point& x, vector& g)
    {
        ++space_.waits;
        std::vector<double> exact(n_);
        const double value = host_.value_gradient(*x.data, exact);
        for (std::size_t i = 0; i < n_; ++i) (*g.data)[i] = float(exact[i]);
        return value;
    }

    void step(const point& x, double a, const vector& d, point& out) const
    {
        for (std::size_t i = 0; i < n_; ++i) (*out.data)[i] = (*x.data)[i] + a * double((*d.data)[i]);
    }

    double max_step(const point&, const vector&)
    {
        ++space_.waits;
        return 100;
    }

    void values(const point& x, const vector& d, std::span<const double> a, std::span<double> out)
    {
        ++space_.waits;
        point trial = make_point();
        for (std::size_t i = 0; i < a.size(); ++i)
        {
            step(x, a[i], d, trial);
            out[i] = host_.value(*trial.data);
        }
    }

private:
    std::size_t n_;
    decltype(functions::chain(2)) host_;
    device_space space_;
};

static_assert(objective<device_objective> && full_objective<device_objective>::batches);

} // namespace

TEST_CASE("device model: points in double and vectors in float reach gradients of 1e-8")
{
    for (const auto which : {method::lbfgs, method::conjugate_gradient})
    {
        device_objective f(80);
        auto x = f.make_point();
        *x.data = functions::noise(80);
        const auto r = minimize(f, x, {.method = which, .gradient_tolerance = 1e-8});
        CAPTURE(r);
        CHECK(r.stop == stop::gradient);

        auto host = functions::chain(80);
        std::vector<double> y = functions::noise(80);
        const auto reference = minimize(host, y, {.method = which, .gradient_tolerance = 1e-8});
        CHECK(r.value == doctest::Approx(reference.value).epsilon(1e-12));
        CHECK(functions::largest_rise(r) <= 1e-14);
    }
}

TEST_CASE("device model: an iteration whose full step is accepted makes the host wait three times")
{
    for (const auto which : {method::lbfgs, method::conjugate_gradient})
    {
        device_objective f(80);
        auto x = f.make_point();
        *x.data = functions::noise(80);
        int waits = 0, evaluations = 0, full = 0, iteration = 0;
        const auto watch = [&](const taut::progress& p)
        {
            if (!p.iterate) return true;
            if (p.iteration > 0 && p.step == 1 && p.evaluations == evaluations + 1)
            {
                ++full;
                CHECK(f.space().waits - waits == 3); // max_step, value with gradient, multi_dot
            }
            waits = f.space().waits;
            evaluations = p.evaluations;
            iteration = p.iteration;
            return true;
        };
        minimize(f, x, {.method = which}, {.observer = watch});
        CHECK(full > iteration / 2); // the common case
    }
}

TEST_CASE("device model: the textbook form waits for every product")
{
    const auto waits = [](bool two_loops)
    {
        device_objective f(80);
        auto x = f.make_point();
        *x.data = functions::noise(80);
        const params p{.max_iterations = 20};
        const auto r = two_loops ? minimize_by_two_loops(f, x, p) : minimize(f, x, p);
        return double(f.space().waits) / r.iterations;
    };
    CHECK(waits(false) < 6); // the first iteration's exact search included
    CHECK(waits(true) > 15);
}
