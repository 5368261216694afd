// SPDX-License-Identifier: MIT
#include "functions.hpp"

#include "support/two_loop.hpp"
#include <doctest/doctest.h>

using namespace taut::solve;
using namespace taut::solve::impl;
using vector = std::vector<double>;

namespace
{

constexpr std::size_t dimension = 6;

/// H_{k+1} = V'H V + rho s s' as a dense matrix: the paper's (20), (21), to the letter.
class dense
{
public:
    explicit dense(double gamma) : h_(dimension * dimension)
    {
        for (std::size_t i = 0; i < dimension; ++i) h_[i * dimension + i] = gamma;
    }

    void update(const vector& s, const vector& y)
    {
        double sy = 0;
        for (std::size_t i = 0; i < dimension; ++i) sy += s[i] * y[i];
        std::vector<double> v(dimension * dimension), out(dimension * dimension);
        for (std::size_t i = 0; i < dimension; ++i)
            for (std::size_t j = 0; j < dimension; ++j) v[i * dimension + j] = double(i == j) - y[i] * s[j] / sy;
        for (std::size_t i = 0; i < dimension; ++i)
            for (std::size_t j = 0; j < dimension; ++j)
            {
                out[i * dimension + j] = s[i] * s[j] / sy;
                for (std::size_t k = 0; k < dimension; ++k)
                    for (std::size_t l = 0; l < dimension; ++l)
                        out[i * dimension + j] += v[k * dimension + i] * h_[k * dimension + l] * v[l * dimension + j];
            }
        h_ = out;
    }

    vector operator*(const vector& g) const
    {
        vector out(dimension);
        for (std::size_t i = 0; i < dimension; ++i)
            for (std::size_t j = 0; j < dimension; ++j) out[i] += h_[i * dimension + j] * g[j];
        return out;
    }

private:
    std::vector<double> h_;
};

/// Steps and gradients of a made-up run on a convex quadratic, so that s'y > 0.
struct sampled_run
{
    std::vector<vector> g{functions::noise(dimension, 7)};
    std::vector<vector> d;
    std::vector<double> a{0.5, 2, 0.1, 1, 3, 0.7, 1};

    sampled_run()
    {
        for (std::size_t k = 0; k < a.size(); ++k)
        {
            d.push_back(functions::noise(dimension, unsigned(100 + k)));
            g.push_back(g[k]);
            for (std::size_t i = 0; i < dimension; ++i) g[k + 1][i] += a[k] * double(i + 1) * d[k][i];
        }
    }

    vector s(std::size_t k) const
    {
        vector out(dimension);
        for (std::size_t i = 0; i < dimension; ++i) out[i] = a[k] * d[k][i];
        return out;
    }

    vector y(std::size_t k) const
    {
        vector out(dimension);
        for (std::size_t i = 0; i < dimension; ++i) out[i] = g[k + 1][i] - g[k][i];
        return out;
    }
};

double ratio(const sampled_run& r, std::size_t k)
{
    const host_space space(dimension);
    return space.dot(r.s(k), r.y(k)) / space.dot(r.y(k), r.y(k));
}

void check_equal(const vector& a, const vector& b, double tolerance)
{
    const host_space space(dimension);
    vector difference = a;
    space.axpby(-1, b, 1, difference);
    CHECK(std::sqrt(space.dot(difference, difference)) <= tolerance * std::sqrt(space.dot(b, b)));
}

} // namespace

TEST_CASE_TEMPLATE("inverse hessian: equals the dense formula after every update", Form,
                   gram_inverse_hessian<const host_space>, two_loop_inverse_hessian<const host_space>)
{
    const host_space space(dimension);
    const sampled_run r;
    for (const int m : {0, 1, 3, 20})
        for (const auto scale : {scaling::newest, scaling::largest})
        {
            Form h(space, {.pairs = m, .scaling = scale});
            h.start(r.g[0]);
            h.forget(2);
            vector d(dimension);
            h.multiply(r.g[0]);
            const auto steepest = h.direction(0, d);
            CHECK(steepest.length == doctest::Approx(2)); // the length that was asked for
            CHECK(h.fresh());

            for (std::size_t k = 0; k < r.a.size(); ++k)
            {
                CAPTURE(m);
                CAPTURE(k);
                CHECK(h.propose(r.a[k], r.d[k], r.g[k], r.g[k + 1]) == doctest::Approx(space.dot(r.d[k], r.g[k + 1])));
                REQUIRE(h.accept());
                CHECK(h.gradient_squared() == doctest::Approx(space.dot(r.g[k + 1], r.g[k + 1])));

                const std::size_t kept = std::min(std::size_t(std::max(m, 1)), k + 1), oldest = k + 1 - kept;
                const double gamma = scale == scaling::newest ? ratio(r, k) : std::max(ratio(r, k), ratio(r, oldest));
                dense reference(gamma);
                if (m > 0)
                    for (std::size_t i = oldest; i <= k; ++i) reference.update(r.s(i), r.y(i));
                const vector expected = reference * r.g[k + 1];

                h.multiply(r.g[k + 1]);
                CHECK(h.g_h_g() == doctest::Approx(space.dot(r.g[k + 1], expected)));
                CHECK(h.y_h_g() == doctest::Approx(space.dot(r.y(k), expected)));
                const double t = 0.3;
                const auto info = h.direction(t, d);
                vector direction = r.s(k);
                space.axpby(-1, expected, t, direction);
                check_equal(d, direction, 1e-11);
                CHECK(info.slope == doctest::Approx(space.dot(direction, r.g[k + 1])));
                CHECK(info.length == doctest::Approx(std::sqrt(space.dot(direction, direction))));
            }
        }
}

TEST_CASE_TEMPLATE("inverse hessian: a rejected trial leaves no trace", Form, gram_inverse_hessian<const host_space>,
                   two_loop_inverse_hessian<const host_space>)
{
    const host_space space(dimension);
    const sampled_run r;
    vector with(dimension), without(dimension);
    for (const bool trial : {false, true})
    {
        Form h(space, {.pairs = 2});
        h.start(r.g[0]);
        for (std::size_t k = 0; k < 4; ++k)
        {
            if (trial) h.propose(17, r.d[5], r.g[k], r.g[6]);
            h.propose(r.a[k], r.d[k], r.g[k], r.g[k + 1]);
            h.accept();
        }
        h.multiply(r.g[4]);
        h.direction(0, trial ? with : without);
    }
    CHECK(with == without);
}

TEST_CASE_TEMPLATE("inverse hessian: a pair without positive curvature is left out", Form,
                   gram_inverse_hessian<const host_space>, two_loop_inverse_hessian<const host_space>)
{
    const host_space space(dimension);
    const sampled_run r;
    Form h(space, {.pairs = 3});
    h.start(r.g[0]);
    h.propose(r.a[0], r.d[0], r.g[0], r.g[1]);
    REQUIRE(h.accept());

    vector concave = r.g[1]; // y = -s
    for (std::size_t i = 0; i < dimension; ++i) concave[i] -= r.d[1][i];
    h.propose(1, r.d[1], r.g[1], concave);
    CHECK_FALSE(h.accept());
    CHECK(h.skipped());
    CHECK(h.gradient_squared() == doctest::Approx(space.dot(concave, concave))); // the gradient is taken all the same

    dense reference(ratio(r, 0));
    reference.update(r.s(0), r.y(0));
    vector d(dimension), expected = reference * concave;
    h.multiply(concave);
    CHECK(h.direction(0, d).slope < 0);
    space.axpby(-1, d, 0, d);
    check_equal(d, expected, 1e-12);
}

TEST_CASE_TEMPLATE("inverse hessian: with a preconditioner H0 is gamma times it", Form,
                   gram_inverse_hessian<const host_space>, two_loop_inverse_hessian<const host_space>)
{
    const host_space space(dimension);
    const sampled_run r;
    const auto h0 = [](const vector& v, vector& out)
    {
        for (std::size_t i = 0; i < dimension; ++i)
            out[i] = 5 * v[i] / double(i + 1); // the exact inverse Hessian, times 5
    };
    Form h(space, {.pairs = 4}, h0);
    h.start(r.g[0]);
    for (std::size_t k = 0; k < 6; ++k)
    {
        h.propose(r.a[k], r.d[k], r.g[k], r.g[k + 1]);
        REQUIRE(h.accept());
        h.multiply(r.g[k + 1]);
        vector d(dimension), expected(dimension);
        const auto info = h.direction(0, d);
        for (std::size_t i = 0; i < dimension; ++i)
            expected[i] = -r.g[k + 1][i] / double(i + 1); // gamma takes the 5 away
        check_equal(d, expected, 1e-11);
        CHECK(info.slope == doctest::Approx(space.dot(r.g[k + 1], expected)));
    }
}
