// SPDX-License-Identifier: MIT
#include <cmath>

#include <doctest/doctest.h>

#include <taut/impl/core/compute/record.hpp>

#include "support/device.hpp"
#include "support/opencl.hpp"
#include "support/shared_context.hpp"

using taut::buffer;
using taut::test::random_values;
using taut::test::sized_count;

TEST_CASE_TEMPLATE("trace: a recorded kernel computes what the lambda says, for any count", T, float, double)
{
    taut::queue q(taut::test::shared_context());
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
    CHECK(taut::test::has_built(q, 1));
}

TEST_CASE("trace: an argument of each kind, mixed precision and an index load")
{
    taut::queue q(taut::test::shared_context());
    const auto k = taut::trace<taut::in<taut::idx>, taut::in<double>, taut::out<float>, taut::uniform<taut::idx>>(
        q, "pick", [](auto i, auto at, auto x, auto y, auto shift) { y[i] = taut::cast<float>(x[at[i] + shift]); });
    const buffer<taut::idx> at(q, std::vector<taut::idx>{3, 0, 2});
    const buffer<double> x(q, std::vector<double>{0.25, 1.25, 2.25, 3.25, 4.25});
    buffer<float> y(q, 3);
    k(3, at, x, y, 1);
    CHECK(y.download() == std::vector<float>{4.25f, 1.25f, 3.25f});
    CHECK(k.text().name == "pick");
    CHECK((k.text().source.find("__kernel void pick(") != std::string::npos) == taut::test::compiles_text());
}

TEST_CASE("trace: a recording whose arguments are not those of the tags is refused")
{
    taut::queue q(taut::test::shared_context());
    const auto record = [&](taut::kernel_form form)
    {
        taut::recording r;
        auto x = r.in<float>();
        auto y = r.out<float>();
        y[r.global_id()] = x[r.global_id()];
        return r.finish("move", form);
    };
    using taut::in, taut::inout, taut::out;
    const auto text = record(taut::impl::form_for(q.device()));
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
    taut::queue q(taut::test::shared_context());
    const auto scaled = [&](double factor)
    { return taut::trace<taut::inout<double>>(q, "scaled", [=](auto i, auto x) { x[i] *= factor; }); };
    buffer<double> x(q, std::vector<double>{1, 2});
    scaled(3)(2, x);
    scaled(3)(2, x);
    CHECK(taut::test::has_built(q, 1));
    scaled(2)(2, x);
    CHECK(taut::test::has_built(q, 2));
    CHECK(x.download() == std::vector<double>{18, 36});
}

TEST_CASE("trace: recordings in one program are built once and compute what each does alone")
{
    taut::queue q(taut::test::shared_context());
    const auto form = taut::impl::form_for(q.device());
    // Kernels with and without double, optimised and not, that share helper functions.
    const auto record = [&]<class T>(T, const std::string& name, int power)
    {
        taut::recording r;
        const auto x = r.in<T>("x");
        auto y = r.out<T>("y");
        const auto i = r.global_id();
        auto root = cbrt(x[i]);
        for (int k = 1; k < power; ++k) root = root * cbrt(x[i] + taut::sym<T>(T(k)));
        y[i] = root;
        return r.finish(name, form, power > 1 ? taut::kernel_use::seldom : taut::kernel_use::often);
    };
    const std::vector<taut::kernel_text> texts = {record(0.0f, "narrow", 1), record(0.0, "wide", 1),
                                                  record(0.0f, "narrow_square", 2), record(0.0, "wide_square", 2)};
    const taut::impl::traced_program p(q, texts);
    for (const char* helper : {" taut_cbrt_f32(const float", " taut_cbrt_f64(const double"}) // no text on the host
        CHECK(p.source().find(helper) == p.source().rfind(helper));

    using taut::impl::recorded_kernel;
    const auto run = [&]<class T>(const recorded_kernel& kernel, const std::vector<T>& x)
    {
        const buffer<T> bx(q, x);
        buffer<T> by(q, x.size());
        kernel(x.size(), bx, by);
        return by.download();
    };
    const auto x = random_values<float>(500, 5);
    const auto y = random_values<double>(500, 6);
    const auto narrow = run(recorded_kernel(p, "narrow"), x),
               narrow_square = run(recorded_kernel(p, "narrow_square"), x);
    const auto wide = run(recorded_kernel(p, "wide"), y), wide_square = run(recorded_kernel(p, "wide_square"), y);
    CHECK(taut::test::has_built(q, 1));
    CHECK(narrow == run(recorded_kernel(q, texts[0]), x));
    CHECK(wide == run(recorded_kernel(q, texts[1]), y));
    CHECK(narrow_square == run(recorded_kernel(q, texts[2]), x));
    CHECK(wide_square == run(recorded_kernel(q, texts[3]), y));
    CHECK(wide[7] == doctest::Approx(std::cbrt(y[7])));

    CHECK_THROWS_AS(recorded_kernel(p, "absent"), taut::parameter_error);
    CHECK_THROWS_AS(run(recorded_kernel(p, "wide"), x), taut::parameter_error);
    CHECK_THROWS_AS(taut::impl::traced_program(q, {texts[0], texts[1], texts[0]}), taut::parameter_error);
}

TEST_CASE_TEMPLATE("trace: recordings call no functions but the few that are declared", T, float, double)
{
    taut::queue q(taut::test::shared_context());
    taut::recording r;
    const auto x = r.in<T>("x");
    auto y = r.out<T>("y");
    const auto v = x[r.global_id()];
    y[r.global_id()] = abs(v) + floor(v) + sqrt(v) + cbrt(v) + exp(v) + log(v) + sin(v) + cos(v) + tan(v) + atan(v) +
                       pow(v, taut::sym<T>(T(1.1)) * v) + min(v, taut::sym<T>(T(2))) + max(v, taut::sym<T>(T(2)));
    const auto text = r.finish("all_functions", taut::impl::form_for(q.device()));
    const taut::impl::recorded_kernel built(q, text);
    if (!taut::test::compiles_text()) return;
    const auto options = taut::test::build_options(q, text.source, "all_functions", taut::impl::few_functions);
    CHECK((options.find("_OPENCL_H_") != std::string::npos) == taut::impl::quirks::reads_long_header(q.device()));
}

TEST_CASE("trace: a buffer that is written must not be bound twice")
{
    taut::queue q(taut::test::shared_context());
    buffer<double> x(q, std::vector<double>(10, 1.0)), y(q, std::vector<double>(10, 2.0));
    const auto add = taut::trace<taut::in<double>, taut::in<double>, taut::out<double>>(
        q, "add", [](auto i, auto a, auto b, auto c) { c[i] = a[i] + b[i]; });
    CHECK_THROWS_AS(add(10, x, y, y), taut::device_error);
    add(10, x, x, y);
    CHECK(y.download() == std::vector<double>(10, 2.0));
}

TEST_CASE("trace: double is refused on a device without fp64, also where it is only inside")
{
    taut::queue q(taut::find_device().without_fp64());
    CHECK_THROWS_AS(taut::trace<taut::inout<double>>(q, "wide", [](auto i, auto x) { x[i] *= 2; }), taut::device_error);
    CHECK_THROWS_AS(taut::trace<taut::inout<float>>(
                        q, "inside", [](auto i, auto x) { x[i] = taut::cast<float>(sqrt(taut::cast<double>(x[i]))); }),
                    taut::device_error);
    const auto narrow = taut::trace<taut::inout<float>>(q, "narrow", [](auto i, auto x) { x[i] *= 2; });
    buffer<float> x(q, std::vector<float>{1.5f});
    narrow(1, x);
    CHECK(x.download()[0] == 3);
}

TEST_CASE("recorded_kernel: formulas of doubles run in the precision of the recording, with arguments by name")
{
    taut::queue q(taut::test::shared_context());
    for (const auto type : {taut::scalar_type::f32, taut::scalar_type::f64})
    {
        taut::recording r(type);
        const auto x = r.in<double>("x", type);
        const auto y = r.inout<double>("y", type);
        const auto a = r.scalar<double>("a", type);
        const auto i = r.global_id();
        y[i] = select(x[i] < 0, taut::sym<double>(1.0), 0.1) * y[i] + a;
        const auto form = taut::impl::form_for(q.device());
        const taut::impl::recorded_kernel k(q, r.finish("advance", form));
        CHECK((k.text().source.find("double") == std::string::npos) ==
              (type == taut::scalar_type::f32 || !taut::test::compiles_text()));

        const taut::real_buffer bx(q, type, std::vector<double>{-1, 1, -2});
        taut::real_buffer by(q, type, std::vector<double>{3, 4, 5});
        k(2, {{"y", by}, {"a", 0.1}, {"x", bx}});
        const auto real = [&](double v) { return taut::test::as_real(type, v); };
        const auto got = by.download();
        CHECK(got[0] == real(3 + real(0.1)));
        CHECK(got[1] == doctest::Approx(0.5).epsilon(type == taut::scalar_type::f32 ? 1e-6 : 1e-15));
        CHECK(got[2] == 5);
        // By position, and as a list made at run time.
        by.fill(1);
        k(1, bx, by, 2.0);
        k(1, std::vector<taut::impl::named_argument>{{"x", bx}, {"y", by}, {"a", -1.0}});
        CHECK(by.download()[0] == 2);
    }
}

TEST_CASE("recorded_kernel: a missing, unknown, repeated or wrongly typed argument is refused by its name")
{
    taut::queue q(taut::test::shared_context());
    const auto form = taut::impl::form_for(q.device());
    taut::recording r(taut::scalar_type::f32);
    const auto x = r.in<double>("x", taut::scalar_type::f32);
    const auto at = r.scalar<taut::idx>("at");
    r.out<double>("y", taut::scalar_type::f32)[r.global_id()] = x[at];
    const taut::impl::recorded_kernel k(q, r.finish("pick", form));
    const buffer<float> bx(q, std::vector<float>{1, 2, 3});
    const buffer<double> wide(q, 3);
    buffer<float> by(q, std::vector<float>{0, 0, 0});
    const auto refusal = [&](std::vector<taut::impl::named_argument> arguments)
    {
        try
        {
            k(3, arguments);
        }
        catch (const taut::parameter_error& e)
        {
            return std::string(e.what());
        }
        return std::string("not refused");
    };
    CHECK(refusal({{"x", bx}, {"y", by}}) == "parameter kernel pick: it needs an argument at");
    CHECK(refusal({{"x", bx}, {"y", by}, {"to", 1}}) == "parameter kernel pick: it has no argument to");
    CHECK(refusal({{"x", bx}, {"y", by}, {"y", by}}) == "parameter kernel pick: it has y twice");
    CHECK(refusal({{"x", wide}, {"y", by}, {"at", 1}}) == "parameter kernel pick: x is of another type: float");
    CHECK(refusal({{"x", 1.0f}, {"y", by}, {"at", 1}}) == "parameter kernel pick: x is of another type: float");
    CHECK(refusal({{"x", bx}, {"y", by}, {"at", 1.0}}) == "parameter kernel pick: at is of another type: int");
    CHECK_THROWS_AS(k(3, bx, 1), taut::parameter_error);
    CHECK_THROWS_AS(k(3, bx, 1, by, 1), taut::parameter_error);
    CHECK(q.counters().launches == 0);
    k(3, bx, 1, by);
    CHECK(by.download() == std::vector<float>(3, 2.0f));
}
