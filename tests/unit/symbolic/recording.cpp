// SPDX-License-Identifier: MIT
#include <string>

#include <doctest/doctest.h>

#include <taut/impl/core/symbolic/literal.hpp>
#include <taut/recording.hpp>
#include <taut/symbolic.hpp>

using taut::sym;

namespace
{

int count(const std::string& text, const std::string& what)
{
    int n = 0;
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
}

} // namespace

TEST_CASE("recording: an element is loaded again only after a store to its array")
{
    taut::recording r;
    const auto x = r.in<double>("x");
    const auto y = r.inout<double>("y");
    const auto i = r.global_id();
    const sym<double> before = y[i];
    CHECK(sym<double>(y[i]).id() == before.id());
    const sym<double> from_x = x[i];
    y[i] = 2 * y[i];
    CHECK(sym<double>(y[i]).id() != before.id());
    CHECK(x[i].id() == from_x.id());
    y[i + 1] = y[i] + x[i] + before;
    const std::string source = r.finish("f").source;
    CHECK(count(source, "= y[i0]") == 2);
    CHECK(count(source, "= x[i0]") == 1);
    // the first load comes before the first store, the second after it
    const auto store = source.find("    y[i");
    CHECK(source.find("= y[i0]") < store);
    CHECK(source.rfind("= y[i0]") > store);
}

TEST_CASE("recording: array elements mix with numbers, functions and each other")
{
    taut::recording r;
    const auto x = r.inout<float>("x");
    const auto y = r.inout<float>("y");
    const auto i = r.global_id();
    const auto a = sym<float>(x[i]);
    const auto b = sym<float>(y[i]);
    const auto same = [](auto s, auto t) { return s.id() == t.id(); };
    CHECK(same(x[i] * y[i], a * b));
    CHECK(same(2.0 * x[i] - y[i], 2 * a - b));
    CHECK(same(-x[i], -a));
    CHECK(same(sqrt(x[i]), sqrt(a)));
    CHECK(same(pow(x[i], 2), a * a));
    CHECK(same(max(x[i], y[i]), max(a, b)));
    CHECK(same(select(x[i] < y[i], x[i], 0), select(a < b, a, 0)));
    CHECK(same(taut::cast<double>(x[i]), taut::cast<double>(a)));
    x[i] = y[i];
    CHECK(r.recorded()[r.recorded().stores().back()].operands[1] == b.id());
    const auto auto_reference = y[i];
    y[i] += 1;
    CHECK(sym<float>(auto_reference).id() != b.id()); // a reference reads when it is used
}

TEST_CASE("recording: stores keep their order, and compound assignments read the element")
{
    taut::recording r;
    const auto y = r.inout<double>("y");
    const auto i = r.global_id();
    y[i] = 1;
    y[i] += 2;
    y[i] -= 3;
    y[i] *= 4;
    y[i] /= 5;
    const std::string source = r.finish("f").source;
    CHECK(count(source, "    y[i0] = ") == 5);
    CHECK(count(source, "= y[i0];") == 4);
    CHECK(source.find("0x1p+1") < source.find("0x1.8p+1"));
}

TEST_CASE("recording: indices are arithmetic, may be loaded, and never leave 32 bits")
{
    taut::recording r;
    const auto x = r.in<double>("x");
    const auto cells = r.in<taut::idx>("cells");
    const auto n = r.scalar<taut::idx>("n");
    const auto y = r.out<double>("y");
    const auto i = r.global_id();
    const auto j = r.global_id(1);
    y[i + n * j] = x[cells[i] * 2] + x[cells[i + n] * 2 + 1];
    const taut::kernel_text k = r.finish("gather");
    CHECK(k.source.find("__global const int* cells, const int n, __global double* y") != std::string::npos);
    CHECK(k.source.find("get_global_id(1)") != std::string::npos);
    CHECK(k.source.find("long") == std::string::npos);
}

TEST_CASE("recording: a captured number is a literal, a scalar is an argument")
{
    const auto record = [](double captured)
    {
        taut::recording r;
        const auto y = r.out<double>("y");
        const auto a = r.scalar<double>("a");
        y[r.global_id()] = a * captured;
        return r.finish("f").source;
    };
    CHECK(record(3).find("a * 0x1.8p+1") != std::string::npos);
    CHECK(record(3) != record(5));
}

TEST_CASE("recording: derivatives by loaded values")
{
    taut::recording r;
    const auto x = r.in<double>("x");
    const auto i = r.global_id();
    const sym<double> u = x[i];
    const sym<double> v = x[i + 1];
    const auto g = differentiate(u * u * v, {u, v});
    CHECK(taut::evaluate(g[0], {{u, 3.0}, {v, 5.0}}) == 30);
    CHECK(taut::evaluate(g[1], {{u, 3.0}, {v, 5.0}}) == 9);
}

TEST_CASE("recording: names are identifiers of C, unique, and not those of temporaries")
{
    taut::recording r;
    static_cast<void>(r.in<double>());
    static_cast<void>(r.scalar<float>());
    CHECK(r.arguments()[0].name == "a0");
    CHECK(r.arguments()[1].name == "a1");
    CHECK_THROWS_AS(r.in<double>("a0"), taut::parameter_error);
    CHECK_THROWS_AS(r.in<double>("2x"), taut::parameter_error);
    CHECK_THROWS_AS(r.in<double>("x y"), taut::parameter_error);
    CHECK_THROWS_AS(r.in<double>("t12"), taut::parameter_error);
    CHECK_THROWS_AS(r.in<double>("i0"), taut::parameter_error);
    CHECK_THROWS_AS(r.in<double>("taut_count"), taut::parameter_error);
    CHECK_NOTHROW(r.in<double>("t"));
    CHECK_NOTHROW(r.in<double>("t1x"));
    CHECK_THROWS_AS(r.finish("a kernel"), taut::parameter_error);
    CHECK_THROWS_AS(r.finish(""), taut::parameter_error);
}

TEST_CASE("recording: a recording is current while it lives")
{
    {
        taut::recording r;
        CHECK(&taut::tape::current() == &r.recorded());
    }
    CHECK_THROWS_AS(taut::tape::current(), taut::tape_error);
}

TEST_CASE("recording: a kernel in float is written with doubles, and mentions none")
{
    using taut::scalar_type;
    const auto record = [](scalar_type type, taut::kernel_form form)
    {
        taut::recording r(type);
        const auto x = r.in<double>("x", type);
        const auto starts = r.in<taut::idx>("starts");
        const auto y = r.inout<double>("y", type);
        const auto z = r.out<double>("z", type);
        const auto a = r.scalar<double>("a", type);
        const auto i = r.global_id();
        const sym<double> u = x[i], v = y[i];
        const sym<double> chosen = select(u < 0.5 * v || v != 1, 1.0, 0.0);
        const sym<double> roots = sqrt(u) + cbrt(u) + exp(u) + log(u) + sin(u) + cos(u) + tan(u) + atan(u);
        const sym<double> powers = pow(u, 3) + pow(u, 1.5) + pow(u, 4.0 / 3) + pow(u, v) + pow(2.0, u);
        const sym<double> parts = abs(u) + floor(u) + min(u, 0.25) + max(v, 3) + fabs(-v);
        const sym<double> along = taut::sum_over(starts[i], starts[i + 1], [&](auto k) { return 2 * x[k]; });
        const auto slopes = differentiate(roots * powers + chosen * parts * a, {u, v});
        sym<double> zero{};
        y[i] = 1;
        y[i] += slopes[0] / 3 - slopes[1];
        z[i] = chosen * roots + parts * powers + along + zero + 0.1;
        z[i + 1] = select(chosen > 0.5, sym<double>(1.0), sym<double>(0.0));
        return r.finish("f", form).source;
    };
    for (const auto form : {taut::kernel_form::item, taut::kernel_form::guarded, taut::kernel_form::run})
    {
        const std::string narrow = record(scalar_type::f32, form), wide = record(scalar_type::f64, form);
        CHECK(narrow.find("double") == std::string::npos);
        CHECK(narrow.find("fp64") == std::string::npos);
        CHECK(narrow.find("__global const float* x, __global const int* starts, __global float* y, __global float* z, "
                          "const float a") != std::string::npos);
        CHECK(count(narrow, taut::impl::literal(0.1f)) == 1);
        CHECK(wide.find("float*") == std::string::npos);
        CHECK(wide.find("__global const double* x") != std::string::npos);
    }
}

TEST_CASE("recording: a constant takes the precision of what it meets, and a store that of its array")
{
    using taut::scalar_type;
    taut::recording r; // constants are doubles
    const auto x = r.in<double>("x", scalar_type::f32);
    const auto wide = r.in<double>("wide");
    const auto y = r.out<double>("y", scalar_type::f32);
    const auto i = r.global_id();
    const auto type = [&](sym<double> v) { return r.recorded()[v.id()].type; };
    CHECK(type(x[i]) == scalar_type::f32);
    CHECK(type(0.1 * x[i] + 1) == scalar_type::f32);
    CHECK(type(pow(x[i], 2)) == scalar_type::f32);
    CHECK(type(select(x[i] < 0.1, x[i], 0.1)) == scalar_type::f32);
    CHECK(type(wide[i] * 0.1) == scalar_type::f64);
    CHECK(type(sym<double>(0.1)) == scalar_type::f64);
    CHECK(type(taut::cast(scalar_type::f64, x[i])) == scalar_type::f64);
    CHECK(type(taut::cast(scalar_type::f32, wide[i])) == scalar_type::f32);
    y[i] = wide[i] + 1;
    const auto& tape = r.recorded();
    CHECK(tape[tape[tape.stores().back()].operands[1]].type == scalar_type::f32);
}

TEST_CASE("recording: float that meets double without a cast is an error")
{
    using taut::scalar_type;
    taut::recording r(scalar_type::f32);
    const auto x = r.in<double>("x", scalar_type::f32);
    const auto y = r.inout<double>("y");
    const auto a = r.scalar<double>("a");
    const auto i = r.global_id();
    const sym<double> u = x[i], v = y[i];
    CHECK_THROWS_AS(u + v, taut::tape_error);
    CHECK_THROWS_AS(v - u, taut::tape_error);
    CHECK_THROWS_AS(a * u, taut::tape_error);
    CHECK_THROWS_AS(u / a, taut::tape_error);
    CHECK_THROWS_AS(static_cast<void>(u < v), taut::tape_error);
    CHECK_THROWS_AS(static_cast<void>(v == u), taut::tape_error);
    CHECK_THROWS_AS(select(u < 1, u, v), taut::tape_error);
    CHECK_THROWS_AS(min(u, v), taut::tape_error);
    CHECK_THROWS_AS(pow(u, v), taut::tape_error);
    CHECK_THROWS_AS(y[i] += u, taut::tape_error);
    CHECK_NOTHROW(taut::cast(scalar_type::f64, u) + v);
    CHECK_NOTHROW(y[i] = u); // a store has the type of its array
}
