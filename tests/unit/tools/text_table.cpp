// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <shared/text_table.hpp>

using namespace taut::tools;

TEST_CASE("text_table: durations are read without an exponent")
{
    CHECK(duration(0.00052) == "0.52 ms");
    CHECK(duration(0.0994) == "99 ms");
    CHECK(duration(0.0999) == "0.0999 s");
    CHECK(duration(0.25) == "0.25 s");
    CHECK(duration(12.34) == "12.3 s");
}
