// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <chrono>

#include <taut/impl/core/core/budget.hpp>

using namespace std::chrono_literals;
using taut::impl::budget;

TEST_CASE("budget: without a limit and an observer it never ends")
{
    budget b;
    CHECK(b.proceed());
    CHECK_FALSE(b.over());
    CHECK(b.left() == budget::unlimited);
    CHECK(b.lap() >= 0);
    CHECK(b.total() >= 0);
}

TEST_CASE("budget: an observer that has said no is not asked again")
{
    int asked = 0;
    budget b(budget::unlimited, [&](const taut::progress& p) { return ++asked < 3 && !p.iterate; });
    CHECK(b.proceed());
    CHECK(b.ask({.iterate = false}));
    CHECK_FALSE(b.proceed());
    CHECK_FALSE(b.ask({}));
    CHECK(asked == 3);
    CHECK(b.over());
    CHECK(b.refused());
}

TEST_CASE("budget: the observer is told the time and whether there is a result")
{
    taut::progress last;
    budget b(budget::unlimited, [&](const taut::progress& p) { return last = p, true; });
    b.has_result(false);
    CHECK(b.ask({.iteration = 7, .seconds = -1}));
    CHECK(last.iteration == 7);
    CHECK(last.seconds >= 0);
    CHECK_FALSE(last.usable);
    b.has_result(true);
    CHECK(b.proceed());
    CHECK(last.usable);
    CHECK_FALSE(last.iterate);
}

TEST_CASE("budget: once the time is over the clock says so, and the observer is left alone")
{
    int asked = 0;
    budget b(0s, [&](const taut::progress&) { return ++asked, true; });
    CHECK_FALSE(b.in_time());
    CHECK(b.left() == 0s);
    CHECK_FALSE(b.over()); // nobody has asked
    CHECK_FALSE(b.proceed());
    CHECK(asked == 0);
    CHECK(b.over());
    CHECK_FALSE(b.refused());
}
