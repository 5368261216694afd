// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include <taut/symbolic.hpp>

using taut::evaluate;
using taut::sym;

namespace
{

/// A function of two numbers that is a template on its scalar, so that the host and the tape run the same text.
template <class T, class F>
void check_same(F f)
{
    using std::numeric_limits;
    // volatile: the compiler's own constants of cbrt(x) round better than the library's
    const volatile T samples[] = {T(-2.75),
                                  T(-1),
                                  T(-0.0),
                                  T(0.0),
                                  T(0.3),
                                  T(1),
                                  T(2),
                                  T(1e-3),
                                  T(17.5),
                                  numeric_limits<T>::infinity(),
                                  numeric_limits<T>::quiet_NaN()};
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto x = sym<T>::variable();
    const auto y = sym<T>::variable();
    const sym<T> traced = f(x, y);
    for (const T a : samples)
        for (const T b : samples)
        {
            const T expected = f(a, b);
            const T value = evaluate(traced, {{x, a}, {y, b}});
            CAPTURE(a);
            CAPTURE(b);
            if (std::isnan(expected))
                CHECK(std::isnan(value));
            else
            {
                CHECK(value == expected);
                CHECK(std::signbit(value) == std::signbit(expected));
            }
        }
}

} // namespace

TEST_CASE_TEMPLATE("operators: arithmetic has the host's values bit for bit", T, float, double)
{
    check_same<T>([](auto x, auto) { return +x; });
    check_same<T>([](auto x, auto) { return -x; });
    check_same<T>([](auto x, auto y) { return x + y; });
    check_same<T>([](auto x, auto y) { return x - y; });
    check_same<T>([](auto x, auto y) { return x * y; });
    check_same<T>([](auto x, auto y) { return x / y; });
    check_same<T>([](auto x, auto y) { return x - (-y) + (x + -y) * -x; });
    check_same<T>(
        [](auto x, auto y)
        {
            x += y;
            x *= y;
            x -= y;
            x /= y;
            return x;
        });
}

TEST_CASE_TEMPLATE("operators: literals of any arithmetic type mix with traced values", T, float, double)
{
    // float arithmetic with double literals: the host must narrow explicitly, the tape does it silently
    check_same<T>([](auto x, auto) { return 2 * x + x * 3u - x / 4 + (1 - x); });
    check_same<T>(
        [](auto x, auto)
        {
            using S = decltype(x);
            return S(0.1) * x + S(2.0 / 3);
        });
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto x = sym<T>::variable();
    CHECK(evaluate(0.1 * x, {{x, T(3)}}) == T(0.1) * T(3));
    CHECK(evaluate(x / 0.3f, {{x, T(3)}}) == T(3) / T(0.3f));
    CHECK(evaluate(max(x, 0.1), {{x, T(-1)}}) == T(0.1));
    CHECK(evaluate(min(2, x), {{x, T(5)}}) == T(2));
}

TEST_CASE_TEMPLATE("operators: functions have the host's values", T, float, double)
{
    using std::abs, std::fabs, std::floor, std::sqrt, std::cbrt, std::exp, std::log, std::sin, std::cos, std::tan,
        std::atan;
    using std::pow, std::min, std::max;
    check_same<T>([](auto x, auto) { return abs(x); });
    check_same<T>([](auto x, auto) { return fabs(x); });
    check_same<T>([](auto x, auto) { return floor(x); });
    check_same<T>([](auto x, auto) { return sqrt(x); });
    check_same<T>([](auto x, auto) { return cbrt(x); });
    check_same<T>([](auto x, auto) { return exp(x); });
    check_same<T>([](auto x, auto) { return log(x); });
    check_same<T>([](auto x, auto) { return sin(x); });
    check_same<T>([](auto x, auto) { return cos(x); });
    check_same<T>([](auto x, auto) { return tan(x); });
    check_same<T>([](auto x, auto) { return atan(x); });
    check_same<T>([](auto x, auto y) { return pow(x, y); });
    // for NaN and for signed zeros, too, min and max are the host's
    check_same<T>([](auto x, auto y) { return min(x, y); });
    check_same<T>([](auto x, auto y) { return max(x, y); });
}

TEST_CASE_TEMPLATE("operators: comparisons have the host's values, also for NaN", T, float, double)
{
    const auto one_if = [](auto cond, auto like)
    {
        using S = decltype(like);
        if constexpr (std::is_same_v<decltype(cond), bool>)
            return cond ? S(1) : S(0);
        else
            return select(cond, S(1), S(0));
    };
    check_same<T>([&](auto x, auto y) { return one_if(x < y, x); });
    check_same<T>([&](auto x, auto y) { return one_if(x > y, x); });
    check_same<T>([&](auto x, auto y) { return one_if(x <= y, x); });
    check_same<T>([&](auto x, auto y) { return one_if(x >= y, x); });
    check_same<T>([&](auto x, auto y) { return one_if(x == y, x); });
    check_same<T>([&](auto x, auto y) { return one_if(x != y, x); });
    check_same<T>([&](auto x, auto y) { return one_if(!(x < y), x); });
    check_same<T>([&](auto x, auto y) { return one_if(x < y && y < 2, x); });
    check_same<T>([&](auto x, auto y) { return one_if(x < y || x == 1, x); });
}

TEST_CASE("operators: integers wrap, divide towards zero and compare as on the device")
{
    taut::tape t;
    const taut::tape_scope scope(t);
    using traced = sym<taut::idx>;
    const auto i = traced::variable();
    const auto j = traced::variable();
    const auto value = [&](traced f, taut::idx a, taut::idx b) { return evaluate(f, {{i, a}, {j, b}}); };
    CHECK(value(i + 2 * j, 3, 4) == 11);
    CHECK(value(i - j, 3, 4) == -1);
    CHECK(value(-i, 3, 4) == -3);
    CHECK(value(i / j, -7, 2) == -3);
    CHECK(value(i % j, -7, 2) == -1);
    CHECK(value(i * 0, 5, 1) == 0);
    CHECK(value(min(i, j), 3, 4) == 3);
    CHECK(value(max(i, j), 3, 4) == 4);
    CHECK(value(abs(i), -3, 0) == 3);
    CHECK(value(select(i < j, i, 9), 5, 4) == 9);
    CHECK(value(i + 1, std::numeric_limits<taut::idx>::max(), 0) == std::numeric_limits<taut::idx>::min());
    CHECK_THROWS_AS(value(i / j, 1, 0), taut::tape_error);
    CHECK_THROWS_AS(value(i % j, std::numeric_limits<taut::idx>::min(), -1), taut::tape_error);
}

TEST_CASE("cast: converts between the precisions and from and to integers")
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto x = sym<double>::variable();
    const auto f = sym<float>::variable();
    const auto i = sym<taut::idx>::variable();
    CHECK(evaluate(taut::cast<float>(x), {{x, 0.1}}) == 0.1f);
    CHECK(evaluate(taut::cast<double>(f), {{f, 0.1f}}) == double(0.1f));
    CHECK(evaluate(taut::cast<double>(i), {{i, 7}}) == 7.0);
    CHECK(evaluate(taut::cast<taut::idx>(x), {{x, -2.9}}) == -2);
    CHECK_THROWS_AS(evaluate(taut::cast<taut::idx>(x), {{x, 3e9}}), taut::tape_error);
    CHECK(taut::cast<double>(x).id() == x.id());
    CHECK(evaluate(taut::cast<float>(sym<double>(0.1))) == 0.1f);
    CHECK(taut::cast<float>(taut::cast<double>(f)).id() == f.id()); // widening is exact
    CHECK(taut::cast<taut::idx>(taut::cast<double>(i)).id() == i.id());
    // there and back is a rounding: it must not cancel
    CHECK(evaluate(taut::cast<double>(taut::cast<float>(x)), {{x, 0.1}}) == double(0.1f));
    CHECK(taut::cast<float>(0.1) == 0.1f);
    static_assert(std::is_same_v<taut::impl::value_type_t<sym<float>>, float>);
    static_assert(std::is_same_v<taut::impl::value_type_t<double>, double>);
}

TEST_CASE_TEMPLATE("pow: integers, halves and thirds become products, roots and one reciprocal", T, float, double)
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto x = sym<T>::variable();
    CHECK(pow(x, 1).id() == x.id());
    CHECK(pow(x, 2).id() == (x * x).id());
    CHECK(pow(x, T(3)).id() == (x * (x * x)).id());
    CHECK(pow(x, sym<T>(4)).id() == ((x * x) * (x * x)).id());
    CHECK(pow(x, 0.5).id() == sqrt(x).id());
    CHECK(pow(x, 1.5).id() == (x * sqrt(x)).id());
    CHECK(pow(x, -1).id() == (1 / x).id());
    CHECK(pow(x, -2).id() == (1 / (x * x)).id());
    CHECK(pow(x, -0.5).id() == (1 / sqrt(x)).id());
    CHECK(evaluate(pow(x, 0), {{x, std::numeric_limits<T>::quiet_NaN()}}) == T(1));
    CHECK(pow(x, -1.5).id() == (1 / (x * sqrt(x))).id());
    CHECK(t[pow(x, 0.3).id()].op == taut::impl::opcode::pow);
    CHECK(t[pow(x, 0.667).id()].op == taut::impl::opcode::pow);
    CHECK(t[pow(x, 1000).id()].op == taut::impl::opcode::pow);

    const double unit = std::numeric_limits<T>::epsilon();
    for (int doubled = -16; doubled <= 16; ++doubled)
        for (const T a : {T(0.7), T(1.3), T(2.5)})
        {
            CAPTURE(doubled);
            const double expected = std::pow(double(a), doubled / 2.0);
            CHECK(std::abs(evaluate(pow(x, doubled / 2.0), {{x, a}}) - expected) <= 8 * unit * expected);
        }
    for (int tripled = -16; tripled <= 16; ++tripled)
        for (const T a : {T(0.7), T(1.3), T(2.5)})
        {
            CAPTURE(tripled);
            const auto third = pow(x, T(tripled / 3.0));
            CHECK(t[third.id()].op != taut::impl::opcode::pow);
            const double expected = std::pow(double(a), tripled / 3.0);
            CHECK(std::abs(evaluate(third, {{x, a}}) - expected) <= 16 * unit * expected);
        }
    // where pow has no value, its replacements have none
    for (const double exponent : {0.5, -0.5, 1.5, 1.0 / 3, -2.0 / 3, 4.0 / 3})
        CHECK(std::isnan(evaluate(pow(x, exponent), {{x, T(-1)}})));
    for (const double exponent : {0.5, 1.0 / 3, 2.0 / 3, 3.0}) CHECK(evaluate(pow(x, exponent), {{x, T(0)}}) == 0);
    for (const double exponent : {-0.5, -1.0 / 3, -2.0})
        CHECK(evaluate(pow(x, exponent), {{x, T(0)}}) == std::numeric_limits<T>::infinity());
}
