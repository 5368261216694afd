// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>
#include <regex>

#include <doctest/doctest.h>

#include <taut/impl/core/symbolic/literal.hpp>
#include <taut/recording.hpp>
#include <taut/symbolic.hpp>

using taut::sym;
using taut::impl::literal;

namespace
{

/// Reads a literal as a C compiler would: parentheses, a sign, the suffix of the type.
template <class T>
T parse(std::string text)
{
    const bool negative = text.front() == '(';
    if (negative) text = text.substr(2, text.size() - 3);
    if constexpr (std::is_same_v<T, float>)
    {
        REQUIRE(text.back() == 'f');
        text.pop_back();
    }
    char* end = nullptr;
    const T value = std::is_same_v<T, float> ? T(std::strtof(text.c_str(), &end)) : T(std::strtod(text.c_str(), &end));
    REQUIRE(*end == '\0');
    return negative ? -value : value;
}

template <class T>
bool round_trips(T value)
{
    const T back = parse<T>(literal(value));
    return std::memcmp(&back, &value, sizeof(T)) == 0;
}

} // namespace

TEST_CASE_TEMPLATE("emit: literals round-trip bit for bit", T, float, double)
{
    using limits = std::numeric_limits<T>;
    for (const T value :
         {T(0), T(-0.0), T(1), T(-1), T(0.1), T(1) / T(3), limits::max(), limits::lowest(), limits::min(),
          limits::denorm_min(), -limits::denorm_min(), limits::epsilon(), T(1e-40), T(12345.678)})
        CHECK(round_trips(value));

    using word = std::conditional_t<std::is_same_v<T, float>, std::uint32_t, std::uint64_t>;
    std::mt19937_64 random(7);
    bool all = true;
    for (int k = 0; k < 100000; ++k)
    {
        const T value = std::bit_cast<T>(static_cast<word>(random()));
        if (std::isfinite(value)) all &= round_trips(value);
    }
    CHECK(all);
}

TEST_CASE("emit: special literals")
{
    CHECK(literal(1.0) == "0x1p+0");
    CHECK(literal(-1.5f) == "(-0x1.8p+0f)");
    CHECK(literal(-0.0) == "(-0x0p+0)");
    CHECK(literal(std::numeric_limits<float>::infinity()) == "INFINITY");
    CHECK(literal(-std::numeric_limits<float>::infinity()) == "(-INFINITY)");
    CHECK(literal(-std::numeric_limits<double>::infinity()) == "(-(double)INFINITY)");
    CHECK(literal(std::numeric_limits<float>::quiet_NaN()) == "NAN");
    CHECK(literal(std::numeric_limits<double>::quiet_NaN()) == "((double)NAN)");
    CHECK(literal(taut::idx{-3}) == "(-3)");
    CHECK(literal(std::numeric_limits<taut::idx>::min()) == "(-2147483647 - 1)");
}

TEST_CASE("emit: a kernel is one statement an operation, in the order of the recording")
{
    taut::recording r;
    const auto x = r.in<double>("x");
    const auto y = r.inout<double>("y");
    const auto a = r.scalar<double>("a");
    const auto i = r.global_id();
    const auto product = a * x[i]; // C++ leaves the order of evaluation in a sum to the compiler
    y[i] = product + y[i] / 2;
    const taut::kernel_text k = r.finish("axpy");
    CHECK(k.name == "axpy");
    CHECK(k.source == "#pragma OPENCL EXTENSION cl_khr_fp64 : enable\n"
                      "__kernel void axpy(__global const double* x, __global double* y, const double a)\n"
                      "{\n"
                      "    const int i0 = get_global_id(0);\n"
                      "    const double t0 = x[i0];\n"
                      "    const double t1 = y[i0];\n"
                      "    const double t2 = t1 / 0x1p+1;\n"
                      "    const double t3 = a * t0 + t2;\n"
                      "    y[i0] = t3;\n"
                      "}\n");
    using taut::argument_kind, taut::scalar_type;
    CHECK(k.arguments == std::vector<taut::kernel_argument>{{"x", argument_kind::in, scalar_type::f64},
                                                            {"y", argument_kind::inout, scalar_type::f64},
                                                            {"a", argument_kind::scalar, scalar_type::f64}});
}

TEST_CASE("emit: arguments that are used at the plain index are known, those at other places or in a loop are not")
{
    taut::recording r;
    const auto x = r.in<double>("x");
    const auto row = r.in<taut::idx>("row");
    const auto table = r.in<double>("table");
    const auto unused = r.in<double>("unused");
    const auto y = r.out<double>("y");
    const auto z = r.out<double>("z");
    const auto i = r.global_id();
    [[maybe_unused]] const sym<double> nobody_needs = unused[i];
    y[i] = x[i] + taut::sum_over(row[i], row[i + 1], [&](auto k) { return table[k] + table[i]; });
    z[i + 1] = 0.0;
    auto used = r.finish("f").by_index;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    CHECK(used == std::vector<std::size_t>{0, 1, 4});
}

TEST_CASE("emit: a float kernel does not contain `double`, whatever the literals in it")
{
    taut::recording r;
    const auto x = r.in<float>("x");
    const auto g = r.out<float>("g");
    const auto i = r.global_id();
    const sym<float> s = x[i];
    const auto f = pow(s, 2.0 / 3) * 0.1 + max(s, 1e-3) / (3 * sqrt(s) + 1) + log(abs(s)) * cbrt(s) +
                   select(s > 0.25, exp(-s), std::numeric_limits<double>::infinity()) + taut::cast<float>(i);
    g[i] = f;
    g[i + 1] = differentiate(f, s);
    g[i + 2] = std::numeric_limits<double>::quiet_NaN();
    const std::string source = r.finish("f").source;
    CHECK(source.find("double") == std::string::npos);
    CHECK(source.find("fp64") == std::string::npos);
    // every floating-point literal has its suffix
    CHECK_FALSE(std::regex_search(source, std::regex("0x[0-9a-f.]+p[+-][0-9]+[^0-9f]")));
    CHECK(std::regex_search(source, std::regex("0x[0-9a-f.]+p[+-][0-9]+f")));
}

TEST_CASE("emit: only what a store needs is written")
{
    taut::recording r;
    const auto x = r.in<double>("x");
    const auto y = r.out<float>("y");
    const auto i = r.global_id();
    static_cast<void>(log(x[i]));
    y[i] = 1;
    const std::string source = r.finish("f").source;
    CHECK(source.find("log") == std::string::npos);
    CHECK(source.find("y[i0] = 0x1p+0f;") != std::string::npos);
}

TEST_CASE("emit: what is emitted does not depend on dead nodes, and is the same every time")
{
    const auto record = [](bool with_dead_nodes)
    {
        taut::recording r;
        const auto x = r.in<double>("x");
        const auto y = r.out<double>("y");
        const auto i = r.global_id();
        if (with_dead_nodes) static_cast<void>(sin(x[i + 5]) * 3);
        y[i] = x[i] * x[i + 1];
        return r.finish("f").source;
    };
    CHECK(record(false) == record(true));
}

TEST_CASE("emit: choices and logic have no branches")
{
    taut::recording r;
    const auto x = r.in<float>("x");
    const auto y = r.out<float>("y");
    const auto i = r.global_id();
    y[i] = select((x[i] < 1 && !(x[i] == 0)) || x[i] >= 3, x[i] * 2, x[i] / 3);
    const std::string source = r.finish("f").source;
    CHECK(source.find("if") == std::string::npos);
    CHECK(source.find("&&") == std::string::npos);
    CHECK(source.find("||") == std::string::npos);
    CHECK(std::regex_search(source, std::regex("t\\d+ = t\\d+ & t\\d+;")));
    CHECK(std::regex_search(source, std::regex("t\\d+ = t\\d+ \\? t\\d+ : t\\d+;")));
}

TEST_CASE("emit: a product is written inside of the one sum that needs it, so that it can be fused")
{
    taut::recording r;
    const auto x = r.in<double>("x");
    const auto y = r.out<double>("y");
    const auto i = r.global_id();
    const sym<double> a = x[i];
    const sym<double> b = x[i + 1];
    const auto shared = a * b;
    y[i] = a * a - b * b;
    y[i + 1] = shared + 1;
    y[i + 2] = shared - 2;
    y[i + 3] = sqrt(a * 7);
    const std::string source = r.finish("f").source;
    CHECK(std::regex_search(source, std::regex("= (t\\d+) \\* \\1 - (t\\d+) \\* \\2;")));
    CHECK(std::regex_search(source, std::regex("= t\\d+ \\* t\\d+;"))); // the shared one has a name
    CHECK(std::regex_search(source, std::regex("sqrt\\(t\\d+\\)")));
}

TEST_CASE("emit: the forms of a kernel differ only in the indices that a work-item has")
{
    const auto record = [](taut::kernel_form form)
    {
        taut::recording r;
        const auto x = r.in<float>("x");
        const auto y = r.out<float>("y");
        const auto i = r.global_id();
        y[i] = -x[i];
        return r.finish("f", form);
    };
    const auto item = record(taut::kernel_form::item);
    CHECK(item.source == "__kernel void f(__global const float* x, __global float* y)\n"
                         "{\n"
                         "    const int i0 = get_global_id(0);\n"
                         "    const float t0 = x[i0];\n"
                         "    const float t1 = -t0;\n"
                         "    y[i0] = t1;\n"
                         "}\n");
    CHECK(item.arguments.size() == 2);

    const auto guarded = record(taut::kernel_form::guarded);
    CHECK(guarded.source == "__kernel void f(__global const float* x, __global float* y, const int taut_count)\n"
                            "{\n"
                            "    const int i0 = get_global_id(0);\n"
                            "    if (i0 >= taut_count) return;\n"
                            "    const float t0 = x[i0];\n"
                            "    const float t1 = -t0;\n"
                            "    y[i0] = t1;\n"
                            "}\n");
    const taut::kernel_argument count{"taut_count", taut::argument_kind::scalar, taut::scalar_type::i32};
    CHECK(guarded.arguments.back() == count);

    const auto run = record(taut::kernel_form::run);
    CHECK(run.source == "#pragma clang diagnostic ignored \"-Wpass-failed\"\n"
                        "__kernel void f(__global const float* x, __global float* y, const int taut_count)\n"
                        "{\n"
                        "    const int taut_first = (int)get_global_id(0) * 256;\n"
                        "    const int taut_last = min(taut_first + 256, taut_count);\n"
                        "    #pragma clang loop vectorize(assume_safety) vectorize_width(8)\n"
                        "    for (int i0 = taut_first; i0 < taut_last; ++i0)\n"
                        "    {\n"
                        "        const float t0 = x[i0];\n"
                        "        const float t1 = -t0;\n"
                        "        y[i0] = t1;\n"
                        "    }\n"
                        "}\n");
    CHECK(run.arguments.back() == count);
    CHECK(run.form == taut::kernel_form::run);

    const auto part = record(taut::kernel_form::part);
    CHECK(part.source == "#pragma clang diagnostic ignored \"-Wpass-failed\"\n"
                         "static void f(__global const float* x, __global float* y, const int taut_first, "
                         "const int taut_last, const int taut_step)\n"
                         "{\n"
                         "    #pragma clang loop vectorize(assume_safety) vectorize_width(8)\n"
                         "    for (int i0 = taut_first; i0 < taut_last; i0 += taut_step)\n"
                         "    {\n"
                         "        const float t0 = x[i0];\n"
                         "        const float t1 = -t0;\n"
                         "        y[i0] = t1;\n"
                         "    }\n"
                         "}\n");
    CHECK(part.arguments.size() == 5);
}

TEST_CASE("emit: a kernel of seldom use is compiled without optimisations for CPUs, and is the same otherwise")
{
    using taut::kernel_form, taut::kernel_use;
    taut::recording r;
    const auto x = r.inout<float>("x");
    x[r.global_id()] = 2.0f * x[r.global_id()];
    for (const auto form : {kernel_form::item, kernel_form::guarded, kernel_form::run, kernel_form::part})
    {
        const auto often = r.finish("twice", form);
        auto seldom = r.finish("twice", form, kernel_use::seldom);
        const std::string attribute = "__attribute__((optnone)) ";
        const auto at = seldom.source.find(attribute);
        CHECK((at != std::string::npos) == (form == kernel_form::run));
        if (at != std::string::npos) seldom.source.erase(at, attribute.size());
        CHECK(seldom.source == often.source);
        CHECK(seldom.arguments == often.arguments);
    }
}

TEST_CASE_TEMPLATE("emit: a cube root brings its own function, in its own precision", T, float, double)
{
    taut::recording r;
    const auto y = r.inout<T>("y");
    const auto i = r.global_id();
    y[i] = cbrt(y[i]);
    const std::string source = r.finish("f").source;
    const bool f64 = std::is_same_v<T, double>;
    CHECK((source.find("double taut_cbrt_f64(") != std::string::npos) == f64);
    CHECK((source.find("float taut_cbrt_f32(") != std::string::npos) == !f64);
    CHECK((source.find("double") != std::string::npos) == f64);
}

TEST_CASE("emit: a free variable has no place in a kernel")
{
    taut::recording r;
    const auto y = r.out<double>("y");
    y[r.global_id()] = sym<double>::variable();
    CHECK_THROWS_AS(r.finish("f"), taut::tape_error);
}
