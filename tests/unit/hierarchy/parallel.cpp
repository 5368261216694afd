// SPDX-License-Identifier: MIT
#include <atomic>
#include <cstddef>
#include <stdexcept>
#include <thread>
#include <vector>

#include <doctest/doctest.h>

#include <taut/core/parallel.hpp>

using taut::parallel_for;

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
