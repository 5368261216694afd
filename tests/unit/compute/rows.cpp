// SPDX-License-Identifier: MIT
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <thread>

#include <doctest/doctest.h>

#include <taut/symbolic.hpp>

#include "host_memory.hpp"

namespace
{

using namespace taut;
using namespace taut::impl;
using traced_index = sym<idx>;

/// Numbers that kernels meet, and some that they should not.
template <class T>
std::vector<T> numbers(std::size_t n, unsigned seed)
{
    using limits = std::numeric_limits<T>;
    const T special[] = {0,
                         T(-0.0),
                         1,
                         -1,
                         limits::infinity(),
                         -limits::infinity(),
                         limits::quiet_NaN(),
                         limits::denorm_min(),
                         limits::max(),
                         limits::min()};
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-4, 4);
    std::vector<T> all(n);
    for (T& x : all) x = random() % 16 == 0 ? special[random() % std::size(special)] : T(real(random));
    return all;
}

std::vector<idx> integers(std::size_t n, idx below, unsigned seed)
{
    std::mt19937 random(seed);
    std::vector<idx> all(n);
    for (idx& x : all) x = static_cast<idx>(random() % static_cast<unsigned>(below));
    return all;
}

} // namespace

TEST_CASE_TEMPLATE("rows: each operation has the values of the host, also of NaN, infinity and -0", T, float, double)
{
    recording r(scalar_type_of<T>);
    const auto x = r.in<T>("x"), y = r.in<T>("y");
    const auto k = r.in<idx>("k"), l = r.in<idx>("l");
    const auto i = r.global_id();
    const sym<T> a = x[i], b = y[i];
    const traced_index m = k[i], n = l[i];
    idx count = 0;
    const auto out = r.out<T>("out");
    const auto whole = r.out<idx>("whole");
    const auto wide = r.out<double>("wide");
    const auto write = [&](const auto& array, auto value) { array[i + 300 * count++] = value; };
    for (const sym<T>& value : {a + b,
                                a - b,
                                a * b,
                                a / b,
                                -a,
                                abs(a),
                                floor(a),
                                sqrt(a),
                                exp(a),
                                log(a),
                                sin(a),
                                cos(a),
                                tan(a),
                                atan(a),
                                pow(a, b),
                                min(a, b),
                                max(a, b),
                                select(a < b, a, b),
                                select(a <= b, a, b),
                                select(a == b, a, b),
                                select(a != b, a, b),
                                select(!(a < b), a, b),
                                select(a < b && b < 1, a, b),
                                select(a < b || b < 1, a, b),
                                cast<T>(m),
                                cast<T>(m % n)})
        write(out, value);
    count = 0;
    for (const traced_index& value : {m + n, m - n, m * n, m / n, m % n, -m, abs(m), select(m < n, m, n),
                                      select(m == n, i, m * 1000000 * n), cast<idx>(select(abs(a) < 5, a, sym<T>(1)))})
        write(whole, value);
    count = 0;
    for (const sym<double>& value : {cast<double>(a), cast<double>(m), cast<double>(cast<float>(b))})
        write(wide, value);

    host_memory memory;
    memory.put("x", numbers<T>(300, 1));
    memory.put("y", numbers<T>(300, 2));
    memory.put("k", integers(300, 50, 3));
    auto divisors = integers(300, 7, 4);
    divisors[5] = -1, divisors[6] = 0;
    memory.put("l", divisors);
    memory.put("out", std::vector<T>(26 * 300));
    memory.put("whole", std::vector<idx>(10 * 300));
    memory.put("wide", std::vector<double>(3 * 300));
    CHECK(runs_as_recorded(r, memory, 0, 300));
}

TEST_CASE_TEMPLATE("rows: cube roots are right to the last place or two", T, float, double)
{
    recording r(scalar_type_of<T>);
    const auto x = r.in<T>("x");
    const auto y = r.out<T>("y"), z = r.out<T>("z");
    const auto i = r.global_id();
    y[i] = cbrt(x[i]);
    z[i] = pow(sym<T>(x[i]), T(1.0 / 3));
    host_memory memory;
    auto values = numbers<T>(1000, 5);
    for (std::size_t k = 0; k < 500; ++k) values[k] *= std::ldexp(T(1), static_cast<int>(k % 200) - 100);
    memory.put("x", values);
    memory.put("y", std::vector<T>(1000));
    memory.put("z", std::vector<T>(1000));
    const double ulp = std::numeric_limits<T>::epsilon();
    CHECK(runs_as_recorded(r, memory, 0, 1000, 1, 2 * ulp, 2 * ulp));
}

TEST_CASE_TEMPLATE("rows: sums and products that are computed together", T, float, double)
{
    recording r(scalar_type_of<T>);
    const auto x = r.in<T>("x");
    const auto out = r.out<T>("out");
    const auto i = r.global_id();
    using operation = std::function<sym<T>(sym<T>, sym<T>)>;
    const operation operations[] = {[](auto a, auto b) { return a + b; }, [](auto a, auto b) { return a - b; },
                                    [](auto a, auto b) { return a * b; }};
    const auto at = [&](idx k) -> sym<T> { return x[i + 200 * k]; };
    idx count = 0, argument = 0;
    const auto next = [&] { return at(argument++); };
    for (const auto& inner : operations)
        for (const auto& outer : operations)
        {
            out[i + 200 * count++] = outer(inner(next(), next()), next());
            out[i + 200 * count++] = outer(next(), inner(next(), next()));
            for (const auto& other : operations)
                out[i + 200 * count++] = outer(inner(next(), next()), other(next(), next()));
        }
    host_memory memory;
    std::vector<T> exact(static_cast<std::size_t>(argument) *
                         200); // of few bits, so that contracted products have the same values
    std::mt19937 random(6);
    for (T& v : exact) v = T(int(random() % 512) - 256) / 16;
    memory.put("x", exact);
    memory.put("out", std::vector<T>(static_cast<std::size_t>(count) * 200));
    CHECK(runs_as_recorded(r, memory, 0, 200));
    const kernel_text text = r.finish("f", kernel_form::host);
    CHECK(text.rows->code.size() == 45 + row_program::ahead); // one each
}

TEST_CASE("rows: any number of indices, from any one, in any step, and nothing besides")
{
    recording r;
    const auto x = r.in<double>("x");
    const auto at = r.in<idx>("at");
    const auto y = r.inout<float>("y");
    const auto z = r.out<double>("z"), copy = r.out<double>("copy");
    const auto to = r.out<float>("to");
    const auto shift = r.scalar<idx>("shift");
    const auto factor = r.scalar<double>("factor");
    const auto i = r.global_id();
    const sym<double> value = factor * x[at[i] + shift] - x[i + 1];
    y[i] += cast<float>(value);
    z[i + shift] = value + sym<double>(x[sym<idx>(3)]);
    copy[i] = x[i];
    to[at[i]] = sym<float>(y[i]) * y[i];
    constexpr std::size_t n = 500;
    host_memory memory;
    memory.put("x", numbers<double>(n + 1, 7));
    std::vector<idx> order(n);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(8));
    for (idx& k : order) k = std::max(k - 2, 0);
    memory.put("at", order);
    memory.put("y", std::vector<float>(n, 3));
    memory.put("z", std::vector<double>(n + 2));
    memory.put("copy", std::vector<double>(n));
    memory.put("to", std::vector<float>(n));
    memory.numbers = {{"shift", to_bits(idx(2))}, {"factor", to_bits(0.5)}};
    for (const idx count : {0, 1, 31, 32, 33, 127, 128, 129, 255, 300, 500})
        for (const idx step : {1, 3})
            for (const idx first : {0, 7})
            {
                CAPTURE(count);
                CAPTURE(step);
                CAPTURE(first);
                if (first < count) CHECK(runs_as_recorded(r, memory, first, count, step));
            }
}

TEST_CASE("rows: stores keep their order where they meet")
{
    recording r;
    const auto x = r.in<double>("x");
    const auto twice = r.out<double>("twice"), maybe = r.out<double>("maybe");
    const auto inout = r.inout<double>("inout");
    const auto stride = r.scalar<idx>("stride");
    const auto i = r.global_id();
    const sym<double> a = x[i], b = a * a, c = b + a, before = inout[i];
    twice[i] = c;
    twice[i] = b;
    maybe[i] = c;
    maybe[i + stride] = b;
    inout[i] = b;
    inout[i] = inout[i] + before;
    host_memory memory;
    memory.put("x", numbers<double>(100, 9));
    memory.put("twice", std::vector<double>(100));
    memory.put("maybe", std::vector<double>(200));
    memory.put("inout", numbers<double>(100, 10));
    for (const idx distance : {0, 100})
    {
        memory.numbers["stride"] = to_bits(distance);
        CHECK(runs_as_recorded(r, memory, 0, 100));
    }
}

TEST_CASE("rows: loops run as far as each index says, and load nothing beyond")
{
    recording r;
    const auto rows = r.in<idx>("rows"), columns = r.in<idx>("columns");
    const auto values = r.in<double>("values"), x = r.in<double>("x");
    const auto y = r.out<double>("y"), nested = r.out<double>("nested");
    const auto ends = r.out<idx>("ends");
    const auto i = r.global_id();
    const traced_index begin = rows[i], end = rows[i + 1];
    const sym<double> own = x[i];
    y[i] = own * sum_over(begin, end, [&](traced_index k) { return sym<double>(values[k]) * x[columns[k]]; });
    nested[i] =
        sum_over(begin, end,
                 [&](traced_index k)
                 {
                     const traced_index column = columns[k];
                     return sum_over(rows[column], rows[column + 1],
                                     [&](traced_index l) { return sym<double>(values[l]) * own + cast<double>(k); }) +
                            values[sym<idx>(0)];
                 });
    ends[i] = sum_over(0, end - begin, [&](traced_index k) { return columns[begin + k] * 1000000000; });
    constexpr std::size_t n = 200;
    std::vector<idx> starts = {0};
    std::mt19937 random(11);
    for (std::size_t k = 0; k < n; ++k)
        starts.push_back(starts.back() + static_cast<idx>(k % 5 == 4 ? 0 : random() % 7));
    const auto entries = static_cast<std::size_t>(starts.back());
    host_memory memory;
    memory.put("rows", starts);
    memory.put("columns", integers(entries, n, 12));
    memory.put("values", numbers<double>(entries, 13));
    memory.put("x", numbers<double>(n, 14));
    memory.put("y", std::vector<double>(n));
    memory.put("nested", std::vector<double>(n));
    memory.put("ends", std::vector<idx>(n));
    CHECK(runs_as_recorded(r, memory, 0, n, 1, 0, 1e-9));
    CHECK(runs_as_recorded(r, memory, 4, 5));
}

namespace
{

/// exact: of small integers, whose products and sums have no rounding to be contracted.
template <class T>
bool random_recording_runs(unsigned seed, bool exact)
{
    std::mt19937 random(seed);
    const auto any = [&](const auto& of) { return of[random() % of.size()]; };
    recording r(scalar_type_of<T>);
    const auto x = r.in<T>("x");
    const auto at = r.in<idx>("at");
    const auto out = r.out<T>("out");
    const auto io = r.inout<T>("io");
    const auto u = r.scalar<T>("u");
    const auto i = r.global_id();
    std::vector<sym<T>> reals = {x[i], x[i + 150], x[at[i]], u, u * u, sym<T>(io[i])};
    std::vector<sym_bool> tests = {reals[0] < reals[1], u < 1};
    std::vector<traced_index> indices = {at[i], i};
    const auto keep = [&](sym<T> v) { reals.push_back(exact ? select(abs(v) < 4096, v, sym<T>(1)) : v); };
    for (int k = 0; k < 40; ++k)
    {
        const sym<T> a = any(reals), b = any(reals), c = any(reals), d = any(reals);
        const sym_bool test = any(tests);
        const traced_index j = any(indices);
        switch (random() % 12)
        {
        case 0:
            keep((a + b) * (c - d));
            break;
        case 1:
            keep(c - a * b);
            break;
        case 2:
            keep(a * b - c * d);
            break;
        case 3:
            keep(exact ? floor(a) + b : a / b);
            break;
        case 4:
            keep(select(test, a, b));
            break;
        case 5:
            tests.push_back(a < b && test);
            break;
        case 6:
            tests.push_back(!test || a == b);
            break;
        case 7:
            keep(exact ? -a : sqrt(abs(a)));
            break;
        case 8:
            keep(x[select(test, j, indices[0])]);
            indices.push_back((j + 3) % 150);
            break;
        case 9:
            keep(cast<T>(j) * a);
            break;
        case 10:
            keep(sum_over(j % 3, j % 5, [&](traced_index l) { return x[l] * a + b; }));
            break;
        default:
            io[i] = a;
            keep(io[i]);
        }
    }
    for (idx k = 0; k < 6; ++k) out[i + 150 * k] = reals[reals.size() - 1 - static_cast<std::size_t>(k)];
    host_memory memory;
    auto values = numbers<T>(300, seed);
    if (exact)
        for (T& v : values) v = T(int(random() % 9) - 4);
    memory.put("x", values);
    memory.put("io", std::vector<T>(values.begin(), values.begin() + 150));
    memory.put("at", integers(150, 150, seed + 1));
    memory.put("out", std::vector<T>(900));
    memory.numbers["u"] = to_bits(exact ? T(2) : T(0.75));
    return runs_as_recorded(r, memory, 0, 150, 1, 0, exact ? 0.0 : std::numeric_limits<double>::infinity());
}

} // namespace

TEST_CASE_TEMPLATE("rows: random recordings", T, float, double)
{
    for (unsigned seed = 0; seed < 40; ++seed)
    {
        CAPTURE(seed);
        CHECK(random_recording_runs<T>(seed, true));
        CHECK(random_recording_runs<T>(seed, false));
    }
}

TEST_CASE("rows: results do not depend on how indices are split, nor on threads")
{
    recording r;
    const auto x = r.in<double>("x");
    const auto y = r.out<double>("y");
    const auto i = r.global_id();
    const sym<double> a = x[i], b = x[i + 1];
    y[i] = exp(a * b + a) * sqrt(a * a + b * b) - sin(a) / b;
    host_memory memory;
    memory.put("x", numbers<double>(10001, 15));
    memory.put("y", std::vector<double>(10000));
    const kernel_text text = r.finish("f", kernel_form::host);
    for (const auto& operations : row_operation_sets())
    {
        host_memory whole = memory, parts = memory;
        row_launch(*text.rows, whole.arguments(r.arguments()), operations).run(0, 10000);
        const row_launch launch(*text.rows, parts.arguments(r.arguments()), operations);
        std::thread first([&] { launch.run(0, 3333); }), second([&] { launch.run(3333, 3334); });
        launch.run(3334, 10000);
        first.join();
        second.join();
        CHECK(whole.arrays["y"] == parts.arrays["y"]);
    }
}

TEST_CASE("rows: a free variable is refused")
{
    recording r;
    const auto y = r.out<double>("y");
    y[r.global_id()] = sym<double>::variable();
    CHECK_THROWS_AS(r.finish("f", kernel_form::host), tape_error);
}
