// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <taut/impl/core/compute/kernel.hpp>
#include <taut/impl/core/compute/program/few_functions.hpp>
#include <taut/impl/core/compute/quirks.hpp>

#include "support/contains.hpp"
#include "support/device.hpp"
#include "support/opencl.hpp"
#include "support/shared_context.hpp"

using taut::test::contains;

namespace
{

const std::string axpy = "__kernel void axpy(const float a, __global const float* x, __global float* y)\n"
                         "{ const size_t i = get_global_id(0); y[i] += a * x[i]; }\n"
                         "__kernel void count(__global int* c) { c[get_global_id(0)] = get_local_size(0); }\n";

} // namespace

TEST_CASE("kernel: typed arguments reach their places")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q(taut::test::shared_context());
    const auto k = q.kernel<float, const taut::buffer<float>, taut::buffer<float>>(axpy, "axpy");
    const taut::buffer<float> x(q, std::vector<float>(64, 2.0f));
    taut::buffer<float> y(q, std::vector<float>(64, 1.0f));
    k(64, 3.0f, x, y);
    k({64, 16}, 0.5f, x, y);
    CHECK(y.download() == std::vector<float>(64, 8.0f));
}

TEST_CASE("kernel: nothing runs over an empty range")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q(taut::test::shared_context());
    taut::buffer<float> x(q, 0), y(q, 0);
    q.kernel<float, const taut::buffer<float>, taut::buffer<float>>(axpy, "axpy")(0, 1.0f, x, y);
    CHECK(q.counters().launches == 0);
}

TEST_CASE("kernel: the local size is the one asked for, or a usual one, or the driver's for odd sizes")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q(taut::test::shared_context());
    taut::buffer<taut::idx> c(q, 130);
    const auto k = q.kernel<taut::buffer<taut::idx>>(axpy, "count");
    k({128, 32}, c);
    CHECK(c.download()[0] == 32);
    k(128, c);
    CHECK(c.download()[0] == (q.device().is_gpu() ? 128 : 64));
    k(127, c);
    CHECK(127 % c.download()[0] == 0);
    CHECK_THROWS_AS(k({130, 32}, c), taut::device_error);
}

TEST_CASE("kernel: equal source and options are built once, other options again")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q(taut::test::shared_context());
    using k = taut::typed_kernel<float, const taut::buffer<float>, taut::buffer<float>>;
    k(q, axpy, "axpy");
    k(q, axpy, "axpy");
    taut::typed_kernel<taut::buffer<taut::idx>>(q, axpy, "count");
    CHECK(q.counters().builds == 1);
    k(q, axpy, "axpy", "-DX=1");
    CHECK(q.counters().builds == 2);
    k(q, axpy + "\n", "axpy");
    CHECK(q.counters().builds == 3);
}

TEST_CASE("kernel: quick builds leave optimisations out, and results as they are")
{
    if (!taut::test::compiles_text()) return;
    const auto options_of = [](taut::queue& q)
    {
        taut::typed_kernel<taut::buffer<float>, float> add_to = q.kernel<taut::buffer<float>, float>(
            "__kernel void add_to(__global float* y, const float a) { y[get_global_id(0)] += a; }", "add_to");
        taut::buffer<float> y(q, std::vector<float>(64, 1.0F));
        add_to(64, y, 2.0F);
        CHECK(y.download() == std::vector<float>(64, 3.0F));
        return taut::test::build_options(
            q, "__kernel void add_to(__global float* y, const float a) { y[get_global_id(0)] += a; }", "add_to", "");
    };
    taut::queue full, quick(taut::find_device(), {.quick_builds = true});
    CHECK(options_of(full).find("-cl-opt-disable") == std::string::npos);
    CHECK(options_of(quick).find("-cl-opt-disable") != std::string::npos);
    const taut::test::with_variable wish("TAUT_BUILD", "quick");
    taut::queue asked;
    CHECK(options_of(asked).find("-cl-opt-disable") != std::string::npos);
}

TEST_CASE("kernel: programs that say they call few functions are built without a long header, others with it")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q(taut::test::shared_context());
    const auto without_header = [&](const std::string& options, const std::string& value)
    {
        const std::string source =
            "__kernel void f(__global float* x) { const size_t i = get_global_id(0); x[i] = " + value + "; }";
        taut::buffer<float> x(q, std::vector<float>(64, 9));
        taut::kernel(q, source, "f", options)(64, x);
        CHECK(x.download() == std::vector<float>(64, 3));
        return contains(taut::test::build_options(q, source, "f", options), "_OPENCL_H_");
    };
    const std::string few = taut::impl::few_functions;
    CHECK(without_header(few, "sqrt(x[i])") == taut::impl::quirks::reads_long_header(q.device()));
    CHECK(without_header(few + "-DX=x[i]", "sqrt(X)") == taut::impl::quirks::reads_long_header(q.device()));
    CHECK(!without_header("", "sqrt(x[i])"));
    CHECK(!without_header(few, "half_sqrt(x[i]) > 2.9f ? 3 : 0")); // it calls another one all the same
}

TEST_CASE("kernel: what is built elsewhere is told once, waited for, and built here if nobody else has")
{
    if (!taut::test::compiles_text()) return;
    const std::string text = "__kernel void add_to(__global float* y, const float a) { y[get_global_id(0)] += a; }";
    std::vector<std::string> told;
    int asked = 0;
    bool works = true;
    const auto elsewhere =
        [&](const std::string& source, const std::string& options, const std::vector<std::string>& kernels)
    {
        CHECK(source == text);
        CHECK(kernels.empty());
        told.push_back(options);
        return works ? taut::queue_options::wait_for_build([&] { return ++asked < 3; })
                     : taut::queue_options::wait_for_build();
    };
    taut::queue q(taut::find_device(), {.build_elsewhere = elsewhere});
    const auto right = [&](const std::string& options)
    {
        const auto add_to = q.kernel<taut::buffer<float>, float>(text, "add_to", options);
        taut::buffer<float> y(q, std::vector<float>(64, 1.0F));
        add_to(64, y, 2.0F);
        return y.download() == std::vector<float>(64, 3.0F);
    };
    auto& cache = taut::test::cache_of(q);
    cache.expect(text, "-DA");
    cache.expect(text, "-DA");
    CHECK(told == std::vector<std::string>{"-DA"});
    CHECK(asked == 0);
    CHECK(right("-DB")); // another program waits for nobody
    CHECK(asked == 0);
    CHECK(right("-DA"));
    CHECK(asked == 3);
    CHECK(right("-DA"));
    cache.expect(text, "-DA"); // it is there
    works = false;
    cache.expect(text, "-DC");
    CHECK(right("-DC"));
    CHECK(told == std::vector<std::string>{"-DA", "-DC"});
    CHECK(q.counters().builds == 3);
}

TEST_CASE("kernel: kernels that are compiled elsewhere are told once and waited for at their first launch")
{
    if (!taut::test::compiles_text()) return;
    const std::string text = "__kernel void one(__global float* y) { y[get_global_id(0)] += 1; }\n"
                             "__kernel void two(__global float* y) { y[get_global_id(0)] += 2; }\n";
    std::vector<std::string> told;
    int asked = 0;
    const auto elsewhere =
        [&](const std::string& source, const std::string& options, const std::vector<std::string>& kernels)
    {
        CHECK(source == text);
        CHECK(options == "-DA");
        told.insert(told.end(), kernels.begin(), kernels.end());
        return [&] { return ++asked < 3; };
    };
    taut::queue q(taut::find_device(), {.build_elsewhere = elsewhere});
    const taut::kernel one(q, text, "one", "-DA");
    for (int time = 0; time < 2; ++time) taut::test::cache_of(q).share(text, "-DA", {"two"});
    CHECK(told == std::vector<std::string>{"two"});
    const taut::kernel two(q, text, "two", "-DA");
    taut::buffer<float> y(q, std::vector<float>(64, 0));
    one(64, y);
    CHECK(asked == 0);
    for (int time = 0; time < 2; ++time)
    {
        two(64, y);
        CHECK(asked == 3);
    }
    CHECK(y.download() == std::vector<float>(64, 5));
    CHECK(q.counters().builds == 1);

    taut::queue quick(taut::find_device(), {.quick_builds = true, .build_elsewhere = elsewhere});
    taut::kernel(quick, text, "one", "-DA");
    taut::test::cache_of(quick).share(text, "-DA", {"two"});
    CHECK(told.size() == 1);
}

TEST_CASE("kernel: a compiler's refusal shows kernel, log, device and the numbered lines around the error")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q(taut::test::shared_context());
    const std::string source =
        "#line 1 \"kernels/broken.cl\"\n// one\n// two\n// three\n"
        "__kernel void broken(__global float* x) { x[0] = nowhere; }\n// five\n// six\n// seven\n";
    try
    {
        q.kernel<taut::buffer<float>>(source, "broken");
        FAIL("a broken kernel was built");
    }
    catch (const taut::build_error& e)
    {
        CHECK(e.kernel() == "broken");
        CHECK(contains(e.log(), "nowhere"));
        CHECK(contains(e.device(), q.device().driver_version()));
        CHECK(contains(e.what(), "building kernel broken"));
        CHECK(contains(e.what(), e.log()));
        CHECK(contains(e.excerpt(), "> __kernel void broken"));
        CHECK(contains(e.excerpt(), "// three"));
        CHECK(!contains(e.excerpt(), "// seven"));
        CHECK(e.code() == CL_BUILD_PROGRAM_FAILURE);
    }
    // The failure is not cached as a success.
    CHECK_THROWS_AS(q.kernel<taut::buffer<float>>(source, "broken"), taut::build_error);
    CHECK(q.counters().builds == 0);
}

TEST_CASE("kernel: a compiler that is older than the processor is told as such")
{
    const taut::build_error e("scale", "error: unknown target CPU 'generic'", "", "a device", CL_BUILD_PROGRAM_FAILURE);
    CHECK(contains(e.what(), "older than this processor"));
    CHECK(contains(e.what(), "unknown target CPU"));
}

TEST_CASE("kernel: excerpts number lines as the compiler does")
{
    using taut::impl::build_excerpt;
    const std::string text = "a\nb\nc\nd\ne\nf\ng\nh\ni\n";
    CHECK(build_excerpt(text, "x.cl:5:1: error: no") == "    3 | c\n    4 | d\n    5 > e\n    6 | f\n    7 | g\n");
    CHECK(build_excerpt(text, "x.cl:1:1: error\nx.cl:9:2: error") ==
          "    1 > a\n    2 | b\n    3 | c\n      ...\n    7 | g\n    8 | h\n    9 > i\n");
    CHECK(build_excerpt("#line 1 \"x.cl\"\n" + text, "x.cl:1:1: error") == "    1 > a\n    2 | b\n    3 | c\n");
    CHECK(build_excerpt("#line 1 \"x.cl\"\na\n", "input.cl:2:1: error") == "    1 | #line 1 \"x.cl\"\n    2 > a\n");
    CHECK(contains(build_excerpt(text, "no line named, at 12:30"), "    1 | a\n"));
}

TEST_CASE("kernel: wrong names, argument counts and types are refused in words")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q(taut::test::shared_context());
    CHECK_THROWS_AS(q.kernel<float>(axpy, "absent"), taut::device_error);
    CHECK_THROWS_AS(q.kernel<float>(axpy, "axpy"), taut::device_error);

    taut::queue weak(taut::find_device().without_fp64());
    try
    {
        weak.kernel<double, const taut::buffer<float>, taut::buffer<float>>(axpy, "axpy");
        FAIL("a double argument was allowed");
    }
    catch (const taut::device_error& e)
    {
        CHECK(contains(e.what(), "fp64"));
        CHECK(contains(e.what(), weak.device().name()));
    }
}

TEST_CASE("kernel: a scalar of another size is refused by name")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q(taut::test::shared_context());
    const auto k = q.kernel<double, const taut::buffer<float>, taut::buffer<float>>(axpy, "axpy");
    taut::buffer<float> x(q, 64), y(q, 64);
    try
    {
        k(64, 1.0, x, y);
        FAIL("a double passed for a float");
    }
    catch (const taut::device_error& e)
    {
        CHECK(contains(e.what(), "argument 0 of axpy"));
    }
}

TEST_CASE("kernel: a buffer of another queue's context is refused")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q, other;
    const auto k = q.kernel<taut::buffer<taut::idx>>(axpy, "count");
    taut::buffer<taut::idx> foreign(other, 64);
    CHECK_THROWS_AS(k(64, foreign), taut::device_error);
}

TEST_CASE("kernel: arguments are bound by name in any order")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q(taut::test::shared_context());
    const taut::kernel k(q, axpy, "axpy");
    const taut::buffer<float> x(q, std::vector<float>(64, 2.0f));
    taut::buffer<float> y(q, std::vector<float>(64, 1.0f));
    k(64, {{"a", 3.0f}, {"x", x}, {"y", y}});
    k(64, {{"y", y}, {"a", 0.5f}, {"x", x}});
    k(64, {{"x", x}, {"y", y}, {"a", -1.0f}});
    CHECK(y.download() == std::vector<float>(64, 6.0f));
    const std::vector<taut::impl::named_argument> arguments = {{"y", y}, {"x", x}, {"a", 1.0f}};
    k.launch(64, arguments);
    CHECK(y.download() == std::vector<float>(64, 8.0f));
}

TEST_CASE("kernel: a double narrows to a float parameter, by name")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q(taut::test::shared_context());
    const taut::kernel k(q, axpy, "axpy");
    const taut::real_buffer x(q, taut::scalar_type::f32, std::vector<double>(64, 1.0));
    taut::real_buffer y(q, taut::scalar_type::f32, std::vector<double>(64, 0.0));
    k(64, {{"a", 0.1}, {"x", x}, {"y", y}});
    CHECK(y.download() == std::vector<double>(64, static_cast<double>(0.1f)));
}

TEST_CASE("kernel: what a macro REAL stands for decides the types of arguments")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q(taut::test::shared_context());
    const std::string source = "#pragma OPENCL EXTENSION cl_khr_fp64 : enable\n"
                               "__kernel void scale(const REAL factor, __global REAL* restrict x)\n"
                               "{ x[get_global_id(0)] *= factor; }\n";
    for (const auto type : {taut::scalar_type::f32, taut::scalar_type::f64})
    {
        const taut::kernel k(q, source, "scale", "-DREAL=" + std::string(taut::impl::spelling(type)), type);
        taut::real_buffer x(q, type, std::vector<double>(64, 3.0));
        k(64, {{"factor", 0.1}, {"x", x}});
        CHECK(x.download()[63] == taut::test::as_real(type, 3 * taut::test::as_real(type, 0.1)));
        taut::real_buffer other(q, type == taut::scalar_type::f32 ? taut::scalar_type::f64 : taut::scalar_type::f32,
                                64);
        CHECK_THROWS_AS(k(64, {{"factor", 0.1}, {"x", other}}), taut::parameter_error);
    }
    taut::queue weak(taut::find_device().without_fp64());
    CHECK_THROWS_AS(taut::kernel(weak, source, "scale", "-DREAL=double", taut::scalar_type::f64), taut::device_error);
}

TEST_CASE("kernel: a missing, unknown, repeated or wrongly typed argument is refused by its name")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q(taut::test::shared_context());
    const taut::kernel k(q, axpy, "axpy"), count(q, axpy, "count");
    const taut::buffer<float> x(q, std::vector<float>(64, 2.0f));
    const taut::buffer<double> wide(q, 64);
    taut::buffer<float> y(q, std::vector<float>(64, 1.0f));
    const auto refusal = [&](std::vector<taut::impl::named_argument> arguments)
    {
        try
        {
            k.launch(64, arguments);
        }
        catch (const taut::parameter_error& e)
        {
            return std::string(e.what());
        }
        return std::string("not refused");
    };
    CHECK(contains(refusal({{"a", 1.0f}, {"y", y}}), "kernel axpy: it needs an argument x"));
    CHECK(contains(refusal({{"x", x}, {"y", y}}), "kernel axpy: it needs an argument a"));
    CHECK(contains(refusal({{"a", 1.0f}, {"x", x}, {"z", y}}), "kernel axpy: it has no argument z"));
    CHECK(contains(refusal({{"a", 1.0f}, {"x", x}, {"y", y}, {"z", y}}), "kernel axpy: it has no argument z"));
    CHECK(contains(refusal({{"a", 1.0f}, {"x", x}, {"x", x}}), "kernel axpy: it has x twice"));
    CHECK(contains(refusal({{"a", 1.0f}, {"x", wide}, {"y", y}}), "x is a buffer of float, not a buffer of double"));
    CHECK(
        contains(refusal({{"a", 1.0f}, {"x", 2.0f}, {"y", y}}), "x is a buffer of float, not a number of type float"));
    CHECK(contains(refusal({{"a", x}, {"x", x}, {"y", y}}), "a is a number of type float, not a buffer of float"));
    CHECK(contains(refusal({{"a", 1}, {"x", x}, {"y", y}}), "a is a number of type float, not a number of type int"));
    CHECK_THROWS_AS(count(64, {{"c", y}}), taut::parameter_error);
    CHECK(q.counters().launches == 0);
    CHECK(y.download() == std::vector<float>(64, 1.0f));
}

TEST_CASE("kernel: another number of arguments is refused by position, too")
{
    if (!taut::test::compiles_text()) return;
    taut::queue q(taut::test::shared_context());
    const taut::kernel set(q, "__kernel void set(__global float* x, const float a) { x[get_global_id(0)] = a; }",
                           "set");
    taut::buffer<float> x(q, 64);
    CHECK_NOTHROW(set(64, x, 2.0F));
    CHECK_THROWS_AS(set(64, x), taut::parameter_error);
    CHECK_THROWS_AS(set(64, x, 2.0F, 3.0F), taut::parameter_error);
    CHECK(x.download().back() == 2.0F);
}
