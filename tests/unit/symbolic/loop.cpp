// SPDX-License-Identifier: MIT
#include <string>

#include <doctest/doctest.h>

#include <taut/recording.hpp>
#include <taut/symbolic.hpp>

using taut::sum_over;
using taut::sym;
using traced_index = sym<taut::idx>;

TEST_CASE("sum_over: a sparse product is a loop with its own scope")
{
    taut::recording r;
    const auto rows = r.in<taut::idx>("rows");
    const auto columns = r.in<taut::idx>("columns");
    const auto values = r.in<double>("values");
    const auto x = r.in<double>("x");
    const auto y = r.out<double>("y");
    const auto i = r.global_id();
    const auto begin = rows[i];
    const auto end = rows[i + 1];
    y[i] = sum_over(begin, end,
                    [&](traced_index k)
                    {
                        const auto value = values[k];
                        return value * x[columns[k]];
                    });
    CHECK(r.finish("spmv").source ==
          "#pragma OPENCL EXTENSION cl_khr_fp64 : enable\n"
          "__kernel void spmv(__global const int* rows, __global const int* columns, __global const double* values, "
          "__global const double* x, __global double* y)\n"
          "{\n"
          "    const int i0 = get_global_id(0);\n"
          "    const int t0 = rows[i0];\n"
          "    const int t1 = i0 + 1;\n"
          "    const int t2 = rows[t1];\n"
          "    double t3 = 0;\n"
          "    for (int t4 = t0; t4 < t2; ++t4)\n"
          "    {\n"
          "        const double t5 = values[t4];\n"
          "        const int t6 = columns[t4];\n"
          "        const double t7 = x[t6];\n"
          "        const double t8 = t5 * t7;\n"
          "        t3 += t8;\n"
          "    }\n"
          "    y[i0] = t3;\n"
          "}\n");
}

TEST_CASE("sum_over: values, also of empty and of nested loops")
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto n = traced_index::variable();
    const auto a = sym<double>::variable();
    const auto squares = sum_over(1, n + 1, [&](traced_index k) { return a * taut::cast<double>(k * k); });
    CHECK(taut::evaluate(squares, {{n, 4}, {a, 0.5}}) == 15);
    CHECK(taut::evaluate(squares, {{n, 0}, {a, 0.5}}) == 0);
    const auto triangle =
        sum_over(0, n, [&](traced_index i) { return sum_over(0, i, [&](traced_index j) { return i * j; }); });
    CHECK(taut::evaluate(triangle, {{n, 4}}) == 0 + 0 + 2 * 1 + 3 * 3);
}

TEST_CASE("sum_over: what does not vary with the loop is computed before it, but a load is not")
{
    taut::recording r;
    const auto x = r.in<float>("x");
    const auto y = r.out<float>("y");
    const auto i = r.global_id();
    const auto a = r.scalar<float>("a");
    y[i] = sum_over(0, i, [&](traced_index k) { return sqrt(a) * x[k] * x[i + 3]; });
    const std::string source = r.finish("f").source;
    const auto loop = source.find("for (");
    CHECK(source.find("sqrt(a)") < loop);
    CHECK(source.find("x[") > loop);
}

TEST_CASE("sum_over: an element that is loaded before the loop is not loaded again in it")
{
    taut::recording r;
    const auto x = r.in<float>("x");
    const auto y = r.out<float>("y");
    const auto i = r.global_id();
    const sym<float> own = x[i];
    y[i] = own + sum_over(0, i, [&](traced_index k) { return x[i] * x[k]; });
    const std::string source = r.finish("f").source;
    CHECK(source.find("x[i0]") != std::string::npos);
    CHECK(source.find("x[i0]") == source.rfind("x[i0]"));
}

TEST_CASE("sum_over: a loop's value used outside of it is an error, not a wrong kernel")
{
    taut::recording r;
    const auto x = r.in<float>("x");
    const auto y = r.out<float>("y");
    sym<float> leaked;
    y[0] = sum_over(0, 9, [&](traced_index k) { return leaked = x[k] * 2; });
    CHECK_NOTHROW(r.finish("f"));
    y[1] = leaked;
    CHECK_THROWS_AS(r.finish("f"), taut::tape_error);
}

TEST_CASE("sum_over: stores inside, and derivatives through it, are errors with a sentence")
{
    taut::recording r;
    const auto x = r.in<float>("x");
    const auto y = r.inout<float>("y");
    CHECK_THROWS_AS(sum_over(0, 9,
                             [&](traced_index k)
                             {
                                 y[k] = 1;
                                 return x[k];
                             }),
                    taut::tape_error);
    y[0] = 2; // the failed loop is closed again
    const sym<float> a = x[0];
    const auto sum = sum_over(0, 9, [&](traced_index k) { return a * x[k]; });
    CHECK_THROWS_WITH_AS(differentiate(sum, a), "cannot differentiate through sum_over", taut::tape_error);
    const sym<float> b = x[1];
    CHECK(differentiate(sum * b, b).id() == sum.id()); // it does not depend on b
}
