// SPDX-License-Identifier: MIT
#include <thread>

#include <doctest/doctest.h>

#include <taut/symbolic.hpp>

using taut::sym;

TEST_CASE("tape: equal operations on equal operands are one node")
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto x = sym<double>::variable();
    const auto y = sym<double>::variable();
    CHECK(x.id() != y.id());
    CHECK((x * y + 1.0).id() == (x * y + 1.0).id());
    CHECK((x * y).id() == (y * x).id());
    CHECK((x - y).id() != (y - x).id());
    const std::size_t before = t.size();
    static_cast<void>(1.0 + y * x);
    CHECK(t.size() == before);
}

TEST_CASE("tape: constants are shared bit for bit, by type and by the sign of zero")
{
    taut::tape t;
    const taut::tape_scope scope(t);
    CHECK(sym<double>(0.1).id() == sym<double>(0.1).id());
    CHECK(sym<double>(0.5).id() != sym<double>(0.25).id());
    CHECK(sym<double>(0.0).id() != sym<double>(-0.0).id());
    CHECK(sym<float>(1).id() != sym<double>(1).id());
    CHECK(sym<float>(0.1).id() == sym<float>(0.1f).id()); // a double literal narrows
}

TEST_CASE("tape: many nodes keep their identity while the table grows")
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto x = sym<double>::variable();
    std::vector<taut::impl::node_id> ids;
    for (int k = 2; k < 5000; ++k) ids.push_back((x * k).id());
    const std::size_t size = t.size();
    bool same = true;
    for (int k = 2; k < 5000; ++k) same &= (x * k).id() == ids[static_cast<std::size_t>(k - 2)];
    CHECK(same);
    CHECK(t.size() == size);
}

TEST_CASE("tape: without a scope a sym says so")
{
    CHECK_THROWS_AS(sym<double>(1.0), taut::tape_error);
    CHECK_THROWS_WITH_AS(sym<float>::variable(),
                         "no tape: a sym was used outside of a recording; create a taut::tape_scope first",
                         taut::error);
}

TEST_CASE("tape: scopes nest, and the outer tape comes back")
{
    taut::tape outer;
    const taut::tape_scope scope(outer);
    const auto x = sym<double>::variable();
    const auto later = x * 2 + 1;
    {
        taut::tape inner;
        const taut::tape_scope nested(inner);
        CHECK(&taut::tape::current() == &inner);
        CHECK_THROWS_AS(-later, taut::tape_error); // a node that the inner tape does not have
    }
    CHECK(&taut::tape::current() == &outer);
    CHECK(taut::evaluate(x + 1.0, {{x, 2.0}}) == 3.0);
}

TEST_CASE("tape: each thread has its own current tape")
{
    taut::tape t;
    const taut::tape_scope scope(t);
    bool threw = false;
    double value = 0;
    std::thread(
        [&]
        {
            try
            {
                static_cast<void>(sym<double>(1.0));
            }
            catch (const taut::tape_error&)
            {
                threw = true;
            }
            taut::tape own;
            const taut::tape_scope own_scope(own);
            const auto x = sym<double>::variable();
            value = taut::evaluate(x * x, {{x, 3.0}});
        })
        .join();
    CHECK(threw);
    CHECK(value == 9.0);
    CHECK(&taut::tape::current() == &t);
}

TEST_CASE_TEMPLATE("sym: a value-initialised one is zero", T, float, double, taut::idx)
{
    taut::tape t;
    const taut::tape_scope scope(t);
    sym<T> sum{};
    CHECK(taut::evaluate(sum) == T(0));
    const auto x = sym<T>::variable();
    sum += x;
    sum += x;
    CHECK(taut::evaluate(sum, {{x, T(4)}}) == T(8));
}

TEST_CASE("sym: an integer constant outside of 32 bits is refused")
{
    taut::tape t;
    const taut::tape_scope scope(t);
    CHECK_THROWS_AS(sym<taut::idx>(std::int64_t{1} << 31), taut::tape_error);
    CHECK(taut::evaluate(sym<taut::idx>(std::size_t{7})) == 7);
    CHECK_FALSE(std::is_constructible_v<sym<taut::idx>, double>);
    CHECK_FALSE(std::is_convertible_v<sym<double>, sym<float>>);
}

TEST_CASE_TEMPLATE("tape: identities are applied only where they hold bit for bit", T, float, double)
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto x = sym<T>::variable();
    const auto y = sym<T>::variable();
    CHECK((x * 1).id() == x.id());
    CHECK((1 * x).id() == x.id());
    CHECK((x / 1).id() == x.id());
    CHECK((x - 0).id() == x.id());
    CHECK((x + sym<T>(-0.0)).id() == x.id());
    CHECK((-(-x)).id() == x.id());
    CHECK((x * -1).id() == (-x).id());
    CHECK((x - -y).id() == (x + y).id());
    CHECK((x + -y).id() == (x - y).id());
    // -0 + 0 is +0, infinity * 0 is NaN, infinity - infinity is NaN, and (x + 1) + 1 rounds twice
    CHECK((x + 0).id() != x.id());
    CHECK(std::isnan(taut::evaluate(x * 0, {{x, std::numeric_limits<T>::infinity()}})));
    CHECK(std::isnan(taut::evaluate(x - x, {{x, std::numeric_limits<T>::infinity()}})));
    const T tiny = std::numeric_limits<T>::epsilon() / 2;
    CHECK(taut::evaluate((x + tiny) + tiny, {{x, T(1)}}) == T(1));
    CHECK_FALSE(std::signbit(taut::evaluate(x + 0, {{x, T(-0.0)}})));
}

TEST_CASE_TEMPLATE("tape: constants fold in their own precision", T, float, double)
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const T third = T(1) / T(3);
    const auto folded = sym<T>(1) / sym<T>(3) + sqrt(sym<T>(2)) * 3;
    CHECK(t[folded.id()].op == taut::impl::opcode::constant);
    CHECK(taut::evaluate(folded) == third + std::sqrt(T(2)) * T(3));
    CHECK(taut::evaluate(sym<T>(1) / sym<T>(0)) == std::numeric_limits<T>::infinity());
}

TEST_CASE("tape: logic simplifies")
{
    taut::tape t;
    const taut::tape_scope scope(t);
    const auto x = sym<double>::variable();
    const auto y = sym<double>::variable();
    const taut::sym_bool c = x < y;
    CHECK((!!c).id() == c.id());
    CHECK((c && true).id() == c.id());
    CHECK((c || false).id() == c.id());
    CHECK_FALSE(taut::evaluate(c && !c, {{x, 1.0}, {y, 2.0}}));
    CHECK(t[(c || !c).id()].op == taut::impl::opcode::constant);
    CHECK(select(c, x, x).id() == x.id());
    CHECK(select(!c, x, y).id() == select(c, y, x).id());
    CHECK(select(c, select(c, x, y), 1.0).id() == select(c, x, 1.0).id());
    CHECK(select(sym<double>(1) < sym<double>(2), x, y).id() == x.id());
}
