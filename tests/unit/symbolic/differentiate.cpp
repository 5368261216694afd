// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include <taut/symbolic.hpp>

#include "numeric.hpp"

using taut::differentiate;
using taut::evaluate;
using taut::sym;

namespace
{

/// First and second derivatives of f(x, y), a template on its scalar, against differences of the host function
/// and of the first derivatives.
template <class T, class F>
void check_derivatives(F f, double a, double b)
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto x = sym<T>::variable();
    const auto y = sym<T>::variable();
    const auto g = differentiate(f(x, y), {x, y});
    const auto gx = differentiate(g[0], {x, y});
    const auto gy = differentiate(g[1], {x, y});
    const auto at = [&](sym<T> s, double u, double v) { return double(evaluate(s, {{x, T(u)}, {y, T(v)}})); };

    // The differences are always taken in double; a float kernel then has its own rounding only.
    const double tolerance = std::is_same_v<T, float> ? 2e-5 : 1e-8;
    CHECK(near(at(g[0], a, b), difference([&](double u) { return f(u, b); }, a), tolerance));
    CHECK(near(at(g[1], a, b), difference([&](double v) { return f(a, v); }, b), tolerance));
    if constexpr (std::is_same_v<T, double>)
    {
        CHECK(near(at(gx[0], a, b), difference([&](double u) { return at(g[0], u, b); }, a), 1e-7));
        CHECK(near(at(gx[1], a, b), difference([&](double v) { return at(g[0], a, v); }, b), 1e-7));
        CHECK(near(at(gy[0], a, b), difference([&](double u) { return at(g[1], u, b); }, a), 1e-7));
        CHECK(near(at(gy[1], a, b), difference([&](double v) { return at(g[1], a, v); }, b), 1e-7));
        CHECK(near(at(gx[1], a, b), at(gy[0], a, b), 1e-12));
    }
}

/// 1, 1, 2, 3, ...: each number the sum of two, so 100 nodes as a DAG and 10^20 as a tree.
template <class S>
S fibonacci(S x, int steps)
{
    S a = x;
    S b = x;
    for (int k = 0; k < steps; ++k)
    {
        const S next = a + b;
        a = b;
        b = next;
    }
    return b;
}

} // namespace

TEST_CASE_TEMPLATE("differentiate: arithmetic against finite differences", T, float, double)
{
    check_derivatives<T>([](auto x, auto y) { return -x + y; }, 0.3, -2.1);
    check_derivatives<T>([](auto x, auto y) { return x - y; }, 0.3, -2.1);
    check_derivatives<T>([](auto x, auto y) { return x * y * x; }, 0.3, -2.1);
    check_derivatives<T>([](auto x, auto y) { return x / y; }, 0.3, -2.1);
    check_derivatives<T>([](auto x, auto y) { return 1 / (x * y) + x / 3; }, 0.7, -1.1);
    check_derivatives<T>([](auto x, auto y) { return (x + y) * (x + y) / (1 + x * x); }, 0.7, -1.1);
}

TEST_CASE_TEMPLATE("differentiate: functions against finite differences", T, float, double)
{
    using std::abs, std::sqrt, std::cbrt, std::exp, std::log, std::sin, std::cos, std::tan, std::atan, std::pow;
    check_derivatives<T>([](auto x, auto y) { return abs(x) * y + abs(y); }, 0.7, -1.1);
    check_derivatives<T>([](auto x, auto y) { return sqrt(x * x + y * y); }, 0.7, -1.1);
    check_derivatives<T>([](auto x, auto y) { return cbrt(x * y); }, 0.7, -1.1);
    check_derivatives<T>([](auto x, auto y) { return exp(x * y) + exp(-x); }, 0.7, -1.1);
    check_derivatives<T>([](auto x, auto y) { return log(x + y * y); }, 0.7, -1.1);
    check_derivatives<T>([](auto x, auto y) { return sin(x * y); }, 0.7, -1.1);
    check_derivatives<T>([](auto x, auto y) { return cos(x - y); }, 0.7, -1.1);
    check_derivatives<T>([](auto x, auto y) { return tan(x * y); }, 0.7, -0.6);
    check_derivatives<T>([](auto x, auto y) { return atan(x / y); }, 0.7, -1.1);
    check_derivatives<T>([](auto x, auto y) { return pow(x, y); }, 0.7, -1.1);
    check_derivatives<T>([](auto x, auto y) { return pow(x * y, 0.3f) + pow(x, 2.5f) * pow(y, 3); }, 0.7, 1.1);
    check_derivatives<T>([](auto x, auto y) { return pow(2 + x, -2) * pow(y, -1.5f); }, 0.7, 1.1);
}

TEST_CASE_TEMPLATE("differentiate: min, max and select against finite differences, on each side", T, float, double)
{
    using std::min, std::max;
    const auto smooth_step = [](auto x, auto y)
    {
        if constexpr (std::is_same_v<decltype(x), double>)
            return x < y ? x * x * y : y * y * x;
        else
            return select(x < y, x * x * y, y * y * x);
    };
    for (const double b : {-1.1, 2.3})
    {
        check_derivatives<T>([](auto x, auto y) { return min(x * x, y) * y; }, 0.7, b);
        check_derivatives<T>([](auto x, auto y) { return max(x * y, x + y) * x; }, 0.7, b);
        check_derivatives<T>(smooth_step, 0.7, b);
    }
}

TEST_CASE("differentiate: floor and comparisons have zero derivatives")
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto x = sym<double>::variable();
    const auto y = sym<double>::variable();
    CHECK(differentiate(floor(x) + y, x).id() == sym<double>(0.0).id());
    CHECK(differentiate(select(x < 1, sym<double>(2), 3), x).id() == sym<double>(0.0).id());
    CHECK(differentiate(y * y, x).id() == sym<double>(0.0).id());
    CHECK(differentiate(x, x).id() == sym<double>(1.0).id());
}

TEST_CASE("differentiate: at the branch point of a select, the branch that the comparison takes decides")
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto x = sym<double>::variable();
    const auto d = differentiate(select(x < 1, 2 * x, 5 * x), x);
    CHECK(evaluate(d, {{x, std::nextafter(1.0, 0.0)}}) == 2);
    CHECK(evaluate(d, {{x, 1.0}}) == 5);
    CHECK(evaluate(differentiate(select(x <= 1, 2 * x, 5 * x), x), {{x, 1.0}}) == 2);
    // max(x, c) at x == c is its first argument, as std::max
    CHECK(evaluate(differentiate(max(3 * x, 3.0), x), {{x, 1.0}}) == 3);
    CHECK(evaluate(differentiate(max(sym<double>(3.0), 3 * x), x), {{x, 1.0}}) == 0);
}

TEST_CASE_TEMPLATE("differentiate: an infinite derivative of the untaken branch does not become NaN", T, float, double)
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto x = sym<T>::variable();
    const auto first_and_second = [&](sym<T> f, T at)
    {
        const auto d = differentiate(f, x);
        return std::pair(evaluate(d, {{x, at}}), evaluate(differentiate(d, x), {{x, at}}));
    };
    // sqrt has an infinite slope at 0, and log and 1/x have no value there
    CHECK(first_and_second(select(x > 0, sqrt(x), x), T(0)) == std::pair(T(1), T(0)));
    CHECK(first_and_second(select(x > 0, log(x), 3 * x), T(0)) == std::pair(T(3), T(0)));
    CHECK(first_and_second(x * select(x != 0, 1 / x, x), T(0)) == std::pair(T(0), T(2)));
    // nested, shared between two choices, and passed through more operations
    const auto root = sqrt(x);
    CHECK(first_and_second(select(x > 0, root, select(x < -1, root, 2 * x)), T(0)) == std::pair(T(2), T(0)));
    CHECK(first_and_second(select(x > 0, root, x) + select(x > 1, 2 * root, x), T(0)) == std::pair(T(2), T(0)));
    CHECK(first_and_second(pow(select(x > 0, 1 / root, 2 + x), 2), T(0)) == std::pair(T(4), T(2)));
    // a shared operand keeps its derivative where one of the two branches is taken
    const auto d = differentiate(select(x > 1, root, 2 * root), x);
    CHECK(near(evaluate(d, {{x, T(4)}}), T(0.25), 1e-6));
    CHECK(near(evaluate(d, {{x, T(0.25)}}), T(2), 1e-6));
    // a barrier is infinite outside, and flat
    const auto barrier = select(x > 0, 1 / x, std::numeric_limits<T>::infinity());
    CHECK(evaluate(barrier, {{x, T(0)}}) == std::numeric_limits<T>::infinity());
    CHECK(first_and_second(barrier, T(0)) == std::pair(T(0), T(0)));
    CHECK(first_and_second(barrier, T(2)) == std::pair(T(-0.25), T(0.25)));
}

TEST_CASE("differentiate: the derivative passes through casts, in the type of each side")
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto x = sym<double>::variable();
    const auto y = sym<double>::variable();
    const sym<float> edge = taut::cast<float>(x - y);
    const sym<float> f = edge * edge * 0.5f;
    const auto g = differentiate(f, {x, y});
    static_assert(std::is_same_v<decltype(g)::value_type, sym<double>>);
    CHECK(evaluate(g[0], {{x, 1000.1}, {y, 1000.0}}) == double(float(1000.1 - 1000.0)));
    CHECK(evaluate(g[1], {{x, 1000.1}, {y, 1000.0}}) == -double(float(1000.1 - 1000.0)));
    CHECK(evaluate(differentiate(g[0], y), {{x, 3.0}, {y, 1.0}}) == -1);
    CHECK(evaluate(differentiate(f, edge), {{x, 3.0}, {y, 1.0}}) == 2.0f);
    const auto i = taut::cast<taut::idx>(x);
    CHECK(differentiate(taut::cast<double>(i), x).id() == sym<double>(0.0).id());
}

TEST_CASE("differentiate: variables may be intermediate values, and are held independent")
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto x = sym<double>::variable();
    const auto square = x * x;
    const auto f = square * x;
    const auto g = differentiate(f, {x, square});
    CHECK(evaluate(g[0], {{x, 3.0}}) == 9); // not 27: the square is held
    CHECK(evaluate(g[1], {{x, 3.0}}) == 3);
    CHECK(evaluate(differentiate(f, x), {{x, 3.0}}) == 27);
    CHECK_THROWS_AS(differentiate(f, sym<double>::of(123456)), taut::tape_error);
}

TEST_CASE_TEMPLATE("differentiate: one hundred Fibonacci steps stay one hundred nodes", T, float, double)
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto x = sym<T>::variable();
    const auto f = fibonacci(x, 100);
    CHECK(t.size() <= 110);
    const T expected = fibonacci(T(1), 100); // the 102nd number, 9.27e20
    CHECK(evaluate(f, {{x, T(1)}}) == expected);
    CHECK(near(double(evaluate(differentiate(f, x), {{x, T(1)}})), double(expected), 1e-5));
    CHECK(t.size() <= 400);
}

TEST_CASE("differentiate: a chain of a hundred thousand operations does not exhaust the stack")
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto x = sym<double>::variable();
    sym<double> f = x;
    for (int k = 0; k < 100000; ++k) f = f * 0.5 + x;
    CHECK(near(evaluate(differentiate(f, x), {{x, 1.0}}), 2.0, 1e-12));
}

TEST_CASE("differentiate: a quotient costs one division for the value and one for the gradient")
{
    taut::tape t;
    const taut::tape_scope scope(t);
    std::vector<sym<double>> x(6);
    for (auto& s : x) s = sym<double>::variable();
    const auto det = x[0] * x[1] - x[2] * x[3];
    const auto f = (x[4] / det) * (x[5] / det);
    static_cast<void>(differentiate(f, x));
    int reciprocals = 0;
    for (std::size_t id = 0; id < t.size(); ++id)
        reciprocals += t[static_cast<taut::impl::node_id>(id)].op == taut::impl::opcode::div;
    CHECK(reciprocals == 3); // the two quotients, and one over det
}
