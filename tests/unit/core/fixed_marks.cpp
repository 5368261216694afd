// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstdint>
#include <vector>

#include <taut/impl/core/core/fixed_marks.hpp>

TEST_CASE("fixed marks: coordinates of a vertex are held one by one or all together")
{
    taut::impl::fixed_marks<2> held(4);
    CHECK(held.size() == 4);
    CHECK_FALSE(held.any());
    held[1] = 1;
    held[2] = held.every;
    held[3] = 2;
    CHECK(held.any());
    CHECK(held.test(1, 0));
    CHECK_FALSE(held.test(1, 1));
    CHECK(held.any(1));
    CHECK_FALSE(held.all(1));
    CHECK(held.all(2));
    CHECK_FALSE(held.any(0));
    CHECK(held.count() == 1);
    CHECK(held.pinned() == std::vector<bool>{false, false, true, false});
    CHECK(held.without_pinned() == taut::impl::fixed_marks<2>(std::vector<std::uint8_t>{0, 1, 0, 2}));
    CHECK(taut::impl::fixed_marks<3>::every == 7);
    CHECK(taut::impl::fixed_marks<3>().empty());
}
