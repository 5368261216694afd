// SPDX-License-Identifier: MIT
#include <cmath>

#include <doctest/doctest.h>

#include <taut/compute/record.hpp>

#include "support/device.hpp"

using taut::buffer;
using taut::test::random_values;
using taut::test::sized_count;

TEST_CASE_TEMPLATE("trace: a recorded kernel computes what the lambda says, for any count", T, float, double)
{
    taut::queue q;
    const auto axpy = taut::trace<taut::in<T>, taut::inout<T>, taut::uniform<T>>(
        q, "axpy", [](auto i, auto x, auto y, auto a) { y[i] = a * x[i] + y[i]; });
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{255}, sized_count(10000, 513)})
    {
        const auto hx = random_values<T>(n + 7, 1), hy = random_values<T>(n + 7, 2);
        const buffer<T> x(q, hx);
        buffer<T> y(q, hy);
        axpy(n, x, y, T(0.5));
        axpy({n, 32}, x, y, T(-2));
        const auto result = y.download();
        double worst = 0;
        for (std::size_t i = 0; i < n; ++i)
            worst = std::max(worst, std::abs(static_cast<double>(result[i]) -
                                             (static_cast<double>(hy[i]) - 1.5 * static_cast<double>(hx[i]))));
        CHECK(worst < (std::is_same_v<T, double> ? 1e-14 : 1e-5));
        // Nothing is touched beyond the count.
        for (std::size_t i = n; i < n + 7; ++i) CHECK(result[i] == hy[i]);
    }
    CHECK(q.counters().builds == 1);
}

TEST_CASE("trace: an argument of each kind, mixed precision and an index load")
{
    taut::queue q;
    const auto k = taut::trace<taut::in<taut::idx>, taut::in<double>, taut::out<float>, taut::uniform<taut::idx>>(
        q, "pick", [](auto i, auto at, auto x, auto y, auto shift) { y[i] = taut::cast<float>(x[at[i] + shift]); });
    const buffer<taut::idx> at(q, std::vector<taut::idx>{3, 0, 2});
    const buffer<double> x(q, std::vector<double>{0.25, 1.25, 2.25, 3.25, 4.25});
    buffer<float> y(q, 3);
    k(3, at, x, y, 1);
    CHECK(y.download() == std::vector<float>{4.25f, 1.25f, 3.25f});
    CHECK(k.text().name == "pick");
    CHECK(k.text().source.find("__kernel void pick(") != std::string::npos);
}

TEST_CASE("trace: a recording whose arguments are not those of the tags is refused")
{
    taut::queue q;
    const auto record = [&](taut::kernel_form form)
    {
        taut::recording r;
        auto x = r.in<float>();
        auto y = r.out<float>();
        y[r.global_id()] = x[r.global_id()];
        return r.finish("move", form);
    };
    using taut::in, taut::inout, taut::out;
    const auto text = record(taut::kernel_form::guarded);
    const taut::traced_kernel<in<float>, out<float>> fits(q, text);
    const buffer<float> x(q, std::vector<float>{1, 2});
    buffer<float> y(q, 2);
    fits(2, x, y);
    CHECK(y.download() == std::vector<float>{1, 2});
    CHECK_THROWS_AS((taut::traced_kernel<in<float>, inout<float>>(q, text)), taut::device_error);
    CHECK_THROWS_AS((taut::traced_kernel<in<double>, out<float>>(q, text)), taut::device_error);
    CHECK_THROWS_AS((taut::traced_kernel<in<float>>(q, text)), taut::device_error);
    CHECK_THROWS_AS((taut::traced_kernel<in<float>, out<float>>(q, record(taut::kernel_form::item))),
                    taut::device_error);
}

TEST_CASE("trace: equal recordings share one build, another captured value is another kernel")
{
    taut::queue q;
    const auto scaled = [&](double factor)
    { return taut::trace<taut::inout<double>>(q, "scaled", [=](auto i, auto x) { x[i] *= factor; }); };
    buffer<double> x(q, std::vector<double>{1, 2});
    scaled(3)(2, x);
    scaled(3)(2, x);
    CHECK(q.counters().builds == 1);
    scaled(2)(2, x);
    CHECK(q.counters().builds == 2);
    CHECK(x.download() == std::vector<double>{18, 36});
}

TEST_CASE("trace: recordings in one program are built once and compute what each does alone")
{
    taut::queue q;
    const auto form = q.device().is_cpu() ? taut::kernel_form::run : taut::kernel_form::guarded;
    // Kernels with and without double, that share helper functions.
    const auto record = [&]<class T>(T, const std::string& name, int power)
    {
        taut::recording r;
        const auto x = r.in<T>("x");
        auto y = r.out<T>("y");
        const auto i = r.global_id();
        auto root = cbrt(x[i]);
        for (int k = 1; k < power; ++k) root = root * cbrt(x[i] + taut::sym<T>(T(k)));
        y[i] = root;
        return r.finish(name, form);
    };
    const std::vector<taut::kernel_text> texts = {record(0.0f, "narrow", 1), record(0.0, "wide", 1),
                                                  record(0.0f, "narrow_square", 2), record(0.0, "wide_square", 2)};
    const taut::traced_program p(q, texts);
    for (const char* helper : {" taut_cbrt_f32(const float", " taut_cbrt_f64(const double"})
        CHECK(p.source().find(helper) == p.source().rfind(helper));

    using floats = taut::traced_kernel<taut::in<float>, taut::out<float>>;
    using doubles = taut::traced_kernel<taut::in<double>, taut::out<double>>;
    const auto run = [&]<class Kernel, class T>(const Kernel& kernel, const std::vector<T>& x)
    {
        const buffer<T> bx(q, x);
        buffer<T> by(q, x.size());
        kernel(x.size(), bx, by);
        return by.download();
    };
    const auto x = random_values<float>(500, 5);
    const auto y = random_values<double>(500, 6);
    const auto narrow = run(floats(p, "narrow"), x), narrow_square = run(floats(p, "narrow_square"), x);
    const auto wide = run(doubles(p, "wide"), y), wide_square = run(doubles(p, "wide_square"), y);
    CHECK(q.counters().builds == 1);
    CHECK(narrow == run(floats(q, texts[0]), x));
    CHECK(wide == run(doubles(q, texts[1]), y));
    CHECK(narrow_square == run(floats(q, texts[2]), x));
    CHECK(wide_square == run(doubles(q, texts[3]), y));
    CHECK(wide[7] == doctest::Approx(std::cbrt(y[7])));

    CHECK_THROWS_AS(floats(p, "absent"), taut::parameter_error);
    CHECK_THROWS_AS(floats(p, "wide"), taut::device_error);
    CHECK_THROWS_AS(taut::traced_program(q, {texts[0], texts[1], texts[0]}), taut::parameter_error);
}

TEST_CASE("trace: a buffer that is written must not be bound twice")
{
    taut::queue q;
    buffer<double> x(q, std::vector<double>(10, 1.0)), y(q, std::vector<double>(10, 2.0));
    const auto add = taut::trace<taut::in<double>, taut::in<double>, taut::out<double>>(
        q, "add", [](auto i, auto a, auto b, auto c) { c[i] = a[i] + b[i]; });
    CHECK_THROWS_AS(add(10, x, y, y), taut::device_error);
    add(10, x, x, y);
    CHECK(y.download() == std::vector<double>(10, 2.0));
}

TEST_CASE("trace: double is refused on a device without fp64, also where it is only inside")
{
    taut::queue q(taut::choose_device().without_fp64());
    CHECK_THROWS_AS(taut::trace<taut::inout<double>>(q, "wide", [](auto i, auto x) { x[i] *= 2; }), taut::device_error);
    CHECK_THROWS_AS(taut::trace<taut::inout<float>>(
                        q, "inside", [](auto i, auto x) { x[i] = taut::cast<float>(sqrt(taut::cast<double>(x[i]))); }),
                    taut::device_error);
    const auto narrow = taut::trace<taut::inout<float>>(q, "narrow", [](auto i, auto x) { x[i] *= 2; });
    buffer<float> x(q, std::vector<float>{1.5f});
    narrow(1, x);
    CHECK(x.download()[0] == 3);
}
