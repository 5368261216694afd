// SPDX-License-Identifier: MIT
#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <thread>

#include <doctest/doctest.h>

#include <taut/impl/core/map/made_ahead.hpp>

using taut::impl::made_ahead;

TEST_CASE("made ahead: every value is there once it is asked for")
{
    made_ahead<std::unique_ptr<std::size_t>> squares(50, [](std::size_t k)
                                                     { return std::make_unique<std::size_t>(k * k); });
    for (std::size_t k = 0; k < 50; ++k) CHECK(*squares.take(k) == k * k);
}

TEST_CASE("made ahead: a failure belongs to its value")
{
    made_ahead<int> values(3,
                           [](std::size_t k) -> int
                           {
                               if (k == 1) throw std::runtime_error("broken");
                               return static_cast<int>(k);
                           });
    CHECK(values.take(0) == 0);
    CHECK_THROWS_WITH_AS(values.take(1), "broken", std::runtime_error);
    CHECK(values.take(2) == 2);
}

TEST_CASE("made ahead: what nobody waits for any more is not begun")
{
    std::atomic<int> made{0};
    std::atomic<bool> leaving{false};
    {
        made_ahead<int> values(1000,
                               [&](std::size_t k)
                               {
                                   ++made;
                                   // Nothing beyond the second before this block ends. Not wait(): without futexes, as
                                   // on Windows, that of g++ 12 can miss the call.
                                   while (k > 0 && !leaving) std::this_thread::yield();
                                   std::this_thread::sleep_for(std::chrono::milliseconds(1));
                                   return static_cast<int>(k);
                               });
        values.take(0);
        leaving = true;
    }
    CHECK(made < 1000); // of a second's work, at most what fits between two lines
}
