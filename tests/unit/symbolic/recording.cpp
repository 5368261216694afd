// SPDX-License-Identifier: MIT
#include <string>

#include <doctest/doctest.h>

#include <taut/symbolic/differentiate.hpp>
#include <taut/symbolic/evaluate.hpp>
#include <taut/symbolic/recording.hpp>

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
