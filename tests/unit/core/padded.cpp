// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <taut/impl/core/core/padded.hpp>

TEST_CASE("padded: the next multiple, and 0 for nothing")
{
    CHECK(taut::impl::padded(0, 64) == 0);
    CHECK(taut::impl::padded(1, 64) == 64);
    CHECK(taut::impl::padded(64, 64) == 64);
    CHECK(taut::impl::padded(65, 64) == 128);
    CHECK(taut::impl::padded(1) == 1024);
}
