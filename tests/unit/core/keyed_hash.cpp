// SPDX-License-Identifier: MIT
#include <bit>
#include <cstdint>
#include <set>

#include <doctest/doctest.h>

#include <taut/impl/core/core/keyed_hash.hpp>

using namespace taut;
using namespace taut::impl;

TEST_CASE("keyed_hash: equal words have equal hashes, and -0 is 0")
{
    CHECK(keyed_hash(bits_of({0.0, 1, -0.0})) == keyed_hash(bits_of({-0.0, 1, 0.0})));
    CHECK(keyed_hash<2>({1, 2}) == keyed_hash<2>({1, 2}));
    CHECK(keyed_hash<2>({1, 2}) != keyed_hash<2>({2, 1}));
    CHECK(keyed_hash<1>({0}) != keyed_hash<2>({0, 0}));
}

TEST_CASE("keyed_hash: words that a known hash brings together are spread over the slots")
{
    // All of these are multiples of the inverse of a constant that many tables multiply by.
    std::uint64_t inverse = 1;
    for (int k = 0; k < 6; ++k) inverse *= 2 - 0x9e3779b97f4a7c15u * inverse;
    std::set<std::uint64_t> slots, top;
    for (std::uint64_t i = 0; i < 1000; ++i)
    {
        const std::uint64_t h = keyed_hash<1>({(i << 40) * inverse});
        slots.insert(h & 0xffff);
        top.insert(keyed_hash<1>({i << 54}) & 0xffff);
    }
    CHECK(slots.size() > 950);
    CHECK(top.size() > 950);
}
