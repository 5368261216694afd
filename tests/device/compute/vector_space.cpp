// SPDX-License-Identifier: MIT
#include <cmath>

#include <doctest/doctest.h>

#include <taut/impl/core/compute/gather.hpp>
#include <taut/impl/core/compute/vector_space.hpp>

#include "support/device.hpp"
#include "support/shared_context.hpp"

using taut::device_vectors;
using taut::scalar_type;
using taut::impl::device_vector;
using taut::impl::scalar_type_of;
using taut::test::random_reals;
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
    taut::queue q(taut::test::shared_context());
    const device_vectors space(q, scalar_type_of<T>, 1500);
    auto x = space.make();
    CHECK(x.size() == 1500);
    CHECK(x.padded_size() == 2048);
    CHECK(x.download() == std::vector<double>(1500, 0.0));

    x.upload(std::vector<double>(1500, 2.0));
    auto y = space.make();
    space.axpby(3, x, 0, y);
    space.axpby(1, x, -1, y);
    const auto all = y.data().download();
    CHECK(all[0] == -4);
    for (std::size_t i = 1500; i < all.size(); ++i) REQUIRE(all[i] == 0);
    CHECK_THROWS_AS(x.upload(std::vector<double>(1501)), taut::parameter_error);
}

TEST_CASE_TEMPLATE("device_vectors: axpby, with b = 0 not reading y", T, float, double)
{
    taut::queue q(taut::test::shared_context());
    const std::size_t n = sized_count(3000, 200);
    const device_vectors space(q, scalar_type_of<T>, n);
    const auto hx = random_reals(scalar_type_of<T>, n, 1), hy = random_reals(scalar_type_of<T>, n, 2);
    auto x = space.make(), y = space.make(), bad = space.make();
    x.upload(hx);
    y.upload(hy);
    space.axpby(0.5, x, -2, y);
    const auto sum = y.download();
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i) worst = std::max(worst, std::abs(sum[i] - (0.5 * hx[i] - 2 * hy[i])));
    CHECK(worst < tolerance<T>());

    bad.upload(std::vector<double>(n, std::numeric_limits<double>::quiet_NaN()));
    space.axpby(1, x, 0, bad);
    CHECK(bad.download() == hx);
    space.copy(x, y);
    CHECK(y.download() == hx);
}

TEST_CASE_TEMPLATE("device_vectors: multi_dot agrees with dot, in one wait", T, float, double)
{
    taut::queue q(taut::test::shared_context());
    const std::size_t n = sized_count(20000, 600);
    const device_vectors space(q, scalar_type_of<T>, n);
    std::vector<device_vector> v;
    std::vector<const device_vector*> left, right;
    for (unsigned k = 0; k < 8; ++k) v.emplace_back(space.queue(), space.type(), random_reals(space.type(), n, k));
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
    taut::queue q(taut::test::shared_context());
    const std::size_t n = sized_count(2500, 100);
    const device_vectors space(q, scalar_type_of<T>, n);
    std::vector<std::vector<double>> host;
    std::vector<device_vector> v;
    for (unsigned k = 0; k < 17; ++k)
    {
        host.push_back(random_reals(space.type(), n, k));
        v.emplace_back(space.queue(), space.type(), host.back());
    }
    const auto a = random_values<double>(17, 99);
    for (std::size_t m = 0; m <= 17; ++m)
    {
        CAPTURE(m);
        std::vector<const device_vector*> x;
        for (std::size_t k = 0; k < m; ++k) x.push_back(&v[k]);
        auto out = space.make();
        out.data().fill(7);
        space.linear_combination(std::span(a).first(m), x, out);
        const auto result = out.download();
        double worst = 0;
        for (std::size_t i = 0; i < n; ++i)
        {
            double s = 0;
            for (std::size_t k = 0; k < m; ++k) s += a[k] * host[k][i];
            worst = std::max(worst, std::abs(result[i] - s));
        }
        CHECK(worst < tolerance<T>());
        if (m == 0) continue;
        // Into the first of them it is the same.
        auto first = space.make();
        space.copy(v[0], first);
        x[0] = &first;
        space.linear_combination(std::span(a).first(m), x, first);
        CHECK(first.download() == result);
    }
}

TEST_CASE_TEMPLATE("device_vectors: a step from double positions keeps their precision", T, float, double)
{
    taut::queue q(taut::test::shared_context());
    const std::size_t n = sized_count(1025, 65);
    const device_vectors space(q, scalar_type_of<T>, n);
    const auto hd = random_reals(space.type(), n, 3);
    auto hx = random_values<double>(n, 4);
    for (double& x : hx) x += 1e9; // where a float position would lose the step
    auto x = space.make_points(scalar_type::f64), out = space.make_points(scalar_type::f64);
    auto d = space.make();
    x.upload(hx);
    d.upload(hd);
    space.step(x, 0.125, d, out);
    const auto moved = out.download();
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i) worst = std::max(worst, std::abs(moved[i] - (hx[i] + 0.125 * hd[i])));
    CHECK(worst < 3e-7);
    space.step(x, 0.125, d, x);
    CHECK(x.download() == moved);
    space.copy(x, out);
    CHECK(out.download() == moved);
}

TEST_CASE("device_vectors: float positions step on a device without fp64")
{
    taut::queue q(taut::find_device().without_fp64());
    const device_vectors space(q, scalar_type::f32, 10);
    auto x = space.make(), d = space.make();
    d.upload(std::vector<double>(10, 2.0));
    space.step(x, 0.5, d, x);
    CHECK(x.download() == std::vector<double>(10, 1.0));
    CHECK(space.dot(x, d) == 20);
}

TEST_CASE("device_vectors: vectors, reductions and gathers of a type share one build")
{
    taut::queue q(taut::test::shared_context());
    const device_vectors space(q, scalar_type::f32, 100);
    auto x = space.make(), y = space.make();
    auto point = space.make_points(scalar_type::f64);
    space.axpby(2, x, 3, y);
    space.step(point, 0.5, x, point);
    CHECK(space.dot(x, y) == 0);
    for (const std::size_t n : {2u, 3u, 8u})
    {
        const std::vector<const device_vector*> v(n, &x);
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
    const taut::impl::gather sum(q, offsets, zero, zero, {.components = 3, .cell_stride = 64, .vertex_stride = 64},
                                 scalar_type::f32, scalar_type::f32);
    q.finish();
    CHECK(taut::test::has_built(q, 1));
}

TEST_CASE("device_vectors: a vector of another type is refused")
{
    taut::queue q(taut::test::shared_context());
    for (const scalar_type type : {scalar_type::f32, scalar_type::f64})
    {
        const device_vectors space(q, type, 100);
        CHECK(space.type() == type);
        auto x = space.make(),
             other = space.make_points(type == scalar_type::f32 ? scalar_type::f64 : scalar_type::f32);
        CHECK(x.data().type() == type);
        CHECK(other.data().type() != type);
        CHECK_THROWS_AS(space.dot(x, other), taut::parameter_error);
        CHECK_THROWS_AS(space.axpby(1, x, 1, other), taut::parameter_error);
        CHECK_THROWS_AS(space.axpby(1, x, 0, other), taut::parameter_error);
        CHECK_THROWS_AS(space.copy(x, other), taut::parameter_error);
        CHECK_THROWS_AS(space.step(other, 1, x, x), taut::parameter_error);
        const std::vector<double> a = {1};
        const std::vector<const device_vector*> one = {&x}, wrong = {&other};
        CHECK_THROWS_AS(space.linear_combination(a, one, other), taut::parameter_error);
        CHECK_THROWS_AS(space.linear_combination(a, wrong, x), taut::parameter_error);
        std::vector<double> out(1);
        CHECK_THROWS_AS(space.multi_dot(one, wrong, out), taut::parameter_error);
        CHECK(space.dot(x, x) == 0);
    }
}

TEST_CASE("device_vectors: the space of no dimension")
{
    taut::queue q(taut::test::shared_context());
    const device_vectors space(q, scalar_type::f64, 0);
    auto x = space.make(), y = space.make();
    space.axpby(1, x, 1, y);
    CHECK(space.dot(x, y) == 0);
    CHECK(x.download().empty());
}
