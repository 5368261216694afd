// SPDX-License-Identifier: MIT
#include <cmath>

#include <doctest/doctest.h>

#include <taut/compute/gather.hpp>
#include <taut/compute/vector_space.hpp>

#include "support/device.hpp"

using taut::device_vector;
using taut::device_vectors;
using taut::test::random_values;
using taut::test::sized_count;

namespace
{

template <class T>
double tolerance()
{
    return std::is_same_v<T, double> ? 1e-14 : 1e-5;
}

} // namespace

TEST_CASE_TEMPLATE("device_vectors: a new vector is zero, and its padding is and stays zero", T, float, double)
{
    taut::queue q;
    const device_vectors<T> space(q, 1500);
    auto x = space.make();
    CHECK(x.size() == 1500);
    CHECK(x.padded_size() == 2048);
    CHECK(x.download() == std::vector<T>(1500, T(0)));

    x.upload(std::vector<T>(1500, T(2)));
    auto y = space.make();
    space.axpby(3, x, 0, y);
    space.axpby(1, x, -1, y);
    const auto all = y.data().download();
    CHECK(all[0] == -4);
    for (std::size_t i = 1500; i < all.size(); ++i) REQUIRE(all[i] == 0);
    CHECK_THROWS_AS(x.upload(std::vector<T>(1501)), taut::parameter_error);
}

TEST_CASE_TEMPLATE("device_vectors: axpby, with b = 0 not reading y", T, float, double)
{
    taut::queue q;
    const std::size_t n = sized_count(3000, 200);
    const device_vectors<T> space(q, n);
    const auto hx = random_values<T>(n, 1), hy = random_values<T>(n, 2);
    auto x = space.make(), y = space.make(), bad = space.make();
    x.upload(hx);
    y.upload(hy);
    space.axpby(0.5, x, -2, y);
    const auto sum = y.download();
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i)
        worst = std::max(worst, std::abs(static_cast<double>(sum[i]) -
                                         (0.5 * static_cast<double>(hx[i]) - 2 * static_cast<double>(hy[i]))));
    CHECK(worst < tolerance<T>());

    bad.upload(std::vector<T>(n, std::numeric_limits<T>::quiet_NaN()));
    space.axpby(1, x, 0, bad);
    CHECK(bad.download() == hx);
    space.copy(x, y);
    CHECK(y.download() == hx);
}

TEST_CASE_TEMPLATE("device_vectors: multi_dot agrees with dot, in one wait", T, float, double)
{
    taut::queue q;
    const std::size_t n = sized_count(20000, 600);
    const device_vectors<T> space(q, n);
    std::vector<device_vector<T>> v;
    std::vector<const device_vector<T>*> left, right;
    for (unsigned k = 0; k < 8; ++k) v.emplace_back(space.queue(), random_values<T>(n, k));
    for (std::size_t k = 0; k < 3; ++k) left.push_back(&v[k]);
    for (std::size_t k = 1; k < 8; ++k) right.push_back(&v[k]);

    std::vector<double> out(21);
    const auto before = q.counters();
    space.multi_dot(left, right, out);
    CHECK(q.counters().waits == before.waits + 1);
    CHECK(q.counters().launches == before.launches + 2);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 7; ++j)
            CHECK(out[i * 7 + j] == doctest::Approx(space.dot(*left[i], *right[j])).epsilon(1e-9));
    // The Gram matrix is symmetric bit for bit: pairs are summed in one order.
    CHECK(out[1 * 7 + 1] == out[2 * 7 + 0]);
}

TEST_CASE_TEMPLATE("device_vectors: linear combinations of any number of vectors", T, float, double)
{
    taut::queue q;
    const std::size_t n = sized_count(2500, 100);
    const device_vectors<T> space(q, n);
    std::vector<std::vector<T>> host;
    std::vector<device_vector<T>> v;
    for (unsigned k = 0; k < 17; ++k)
    {
        host.push_back(random_values<T>(n, k));
        v.emplace_back(space.queue(), host.back());
    }
    const auto a = random_values<double>(17, 99);
    for (std::size_t m = 0; m <= 17; ++m)
    {
        CAPTURE(m);
        std::vector<const device_vector<T>*> x;
        for (std::size_t k = 0; k < m; ++k) x.push_back(&v[k]);
        auto out = space.make();
        out.data().fill(7);
        space.linear_combination(std::span(a).first(m), x, out);
        const auto result = out.download();
        double worst = 0;
        for (std::size_t i = 0; i < n; ++i)
        {
            double s = 0;
            for (std::size_t k = 0; k < m; ++k) s += a[k] * static_cast<double>(host[k][i]);
            worst = std::max(worst, std::abs(static_cast<double>(result[i]) - s));
        }
        CHECK(worst < tolerance<T>());
    }
}

TEST_CASE_TEMPLATE("device_vectors: a step from double positions keeps their precision", T, float, double)
{
    taut::queue q;
    const std::size_t n = sized_count(1025, 65);
    const device_vectors<T> space(q, n);
    const auto hd = random_values<T>(n, 3);
    auto hx = random_values<double>(n, 4);
    for (double& x : hx) x += 1e9; // where a float position would lose the step
    auto x = space.template make_points<double>(), out = space.template make_points<double>();
    auto d = space.make();
    x.upload(hx);
    d.upload(hd);
    space.step(x, 0.125, d, out);
    const auto moved = out.download();
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i)
        worst = std::max(worst, std::abs(moved[i] - (hx[i] + 0.125 * static_cast<double>(hd[i]))));
    CHECK(worst < 3e-7);
    space.step(x, 0.125, d, x);
    CHECK(x.download() == moved);
    space.copy(x, out);
    CHECK(out.download() == moved);
}

TEST_CASE("device_vectors: float positions step on a device without fp64")
{
    taut::queue q(taut::choose_device().without_fp64());
    const device_vectors<float> space(q, 10);
    auto x = space.make(), d = space.make();
    d.upload(std::vector<float>(10, 2.0f));
    space.step(x, 0.5, d, x);
    CHECK(x.download() == std::vector<float>(10, 1.0f));
    CHECK(space.dot(x, d) == 20);
}

TEST_CASE("device_vectors: vectors, reductions and gathers of a type share one build")
{
    taut::queue q;
    const device_vectors<float> space(q, 100);
    auto x = space.make(), y = space.make();
    auto point = space.make_points<double>();
    space.axpby(2, x, 3, y);
    space.step(point, 0.5, x, point);
    CHECK(space.dot(x, y) == 0);
    for (const std::size_t n : {2, 3, 8})
    {
        const std::vector<const device_vector<float>*> v(n, &x);
        const std::vector<double> a(n, 1.0);
        space.linear_combination(a, v, y);
        std::vector<double> products(n * n);
        space.multi_dot(v, v, products);
    }
    taut::reductions r(q);
    r.sum(x.data());
    r.minimum(x.data(), 100);
    r.fetch();
    const std::vector<taut::idx> offsets = {0, 1}, zero = {0};
    const taut::gather<float> sum(q, offsets, zero, zero, {.components = 3, .cell_stride = 64, .vertex_stride = 64});
    q.finish();
    CHECK(q.counters().builds == 1);
}

TEST_CASE("device_vectors: the space of no dimension")
{
    taut::queue q;
    const device_vectors<double> space(q, 0);
    auto x = space.make(), y = space.make();
    space.axpby(1, x, 1, y);
    CHECK(space.dot(x, y) == 0);
    CHECK(x.download().empty());
}
