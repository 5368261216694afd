// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <vector>

#include <doctest/doctest.h>

#include <taut/impl/core/core/crew.hpp>
#include <taut/impl/core/core/parallel.hpp>

using taut::impl::parallel_for;

TEST_CASE("parallel_for: every place is visited exactly once")
{
    for (const unsigned threads : {0U, 1U, 2U, 5U})
        for (const std::size_t n : {std::size_t{1}, std::size_t{7}, std::size_t{1000}, std::size_t{100'003}})
        {
            std::vector<int> visits(n, 0);
            parallel_for(
                n,
                [&](std::size_t begin, std::size_t end)
                {
                    for (std::size_t i = begin; i < end; ++i) ++visits[i];
                },
                threads, 16);
            CHECK(visits == std::vector<int>(n, 1));
        }
}

TEST_CASE("parallel_for: nothing to do calls nothing")
{
    int calls = 0;
    parallel_for(0, [&](std::size_t, std::size_t) { ++calls; });
    CHECK(calls == 0);
}

TEST_CASE("parallel_for: a small range stays on the calling thread, in one piece")
{
    int calls = 0;
    std::thread::id where;
    parallel_for(
        100,
        [&](std::size_t begin, std::size_t end)
        {
            ++calls;
            where = std::this_thread::get_id();
            CHECK(begin == 0);
            CHECK(end == 100);
        },
        4, 100);
    CHECK(calls == 1);
    CHECK(where == std::this_thread::get_id());
}

TEST_CASE("parallel_for: an exception arrives at the caller and ends the work")
{
    for (const unsigned threads : {1U, 3U})
    {
        std::atomic<int> pieces{0};
        const auto run = [&]
        {
            parallel_for(
                1000,
                [&](std::size_t, std::size_t)
                {
                    ++pieces;
                    throw std::runtime_error("broken");
                },
                threads, 1);
        };
        CHECK_THROWS_WITH_AS(run(), "broken", std::runtime_error);
        CHECK(pieces <= static_cast<int>(threads)); // each thread throws in its first piece at the latest
    }
}

TEST_CASE("parallel_for: from several threads at once")
{
    constexpr std::size_t n = 2000;
    const auto squares = [](std::vector<int>& out)
    {
        parallel_for(
            n,
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t i = begin; i < end; ++i) out[i] += static_cast<int>(i * i);
            },
            3, 1);
    };
    std::vector<int> expected(n);
    for (std::size_t i = 0; i < n; ++i) expected[i] = static_cast<int>(i * i);

    std::vector<std::vector<int>> results(4, std::vector<int>(n, 0));
    std::vector<std::thread> callers;
    for (auto& r : results)
        callers.emplace_back(
            [&]
            {
                for (int repeat = 0; repeat < 20; ++repeat)
                {
                    std::fill(r.begin(), r.end(), 0);
                    squares(r);
                }
            });
    for (auto& t : callers) t.join();
    for (const auto& r : results) CHECK(r == expected);
}

TEST_CASE("parallel_for: a nested call stays on its thread, and all of it is done")
{
    std::atomic<int> visits{0}, elsewhere{0};
    parallel_for(
        8,
        [&](std::size_t begin, std::size_t end)
        {
            const auto here = std::this_thread::get_id();
            for (std::size_t i = begin; i < end; ++i)
                parallel_for(
                    100,
                    [&](std::size_t from, std::size_t to)
                    {
                        visits += static_cast<int>(to - from);
                        elsewhere += std::this_thread::get_id() != here;
                    },
                    4, 1);
        },
        4, 1);
    CHECK(visits == 800);
    CHECK(elsewhere == 0);
}

namespace
{

/// value: null takes the variable out of the environment.
void set_variable(const char* name, const char* value)
{
#if defined(_WIN32)
    ::_putenv_s(name, value ? value : "");
#else
    value ? ::setenv(name, value, 1) : ::unsetenv(name);
#endif
}

} // namespace

TEST_CASE("parallel_for: the environment bounds the threads, unless it says nonsense")
{
    const auto with = [](const char* wish)
    {
        set_variable("TAUT_THREADS", wish);
        const unsigned threads = taut::impl::threads_at_once();
        set_variable("TAUT_THREADS", nullptr);
        return threads;
    };
    const unsigned all = taut::impl::threads_at_once();
    CHECK(all >= 1);
    CHECK(with("3") == 3);
    CHECK(with("1") == 1);
    for (const char* nonsense : {"", "0", "many", "-2"}) CHECK(with(nonsense) == all);
}
