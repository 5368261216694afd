// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <random>

#include <taut/types.hpp>

namespace taut::impl
{

/// SipHash-1-3 of words (Aumasson, Bernstein: "SipHash: a fast short-input PRF"), with a random key of the process, so
/// that files cannot be made to collide in a hash table, which would make its time quadratic.
template <std::size_t N>
std::uint64_t keyed_hash(const std::array<std::uint64_t, N>& words)
{
    static const std::array<std::uint64_t, 2> key = []
    {
        std::random_device draw;
        const auto word = [&] { return std::uint64_t(draw()) << 32 | draw(); };
        return std::array<std::uint64_t, 2>{word(), word()};
    }();
    std::uint64_t a = key[0] ^ 0x736f6d6570736575u, b = key[1] ^ 0x646f72616e646f6du, c = key[0] ^ 0x6c7967656e657261u,
                  d = key[1] ^ 0x7465646279746573u;
    const auto round = [&]
    {
        a += b, b = std::rotl(b, 13) ^ a, a = std::rotl(a, 32);
        c += d, d = std::rotl(d, 16) ^ c;
        a += d, d = std::rotl(d, 21) ^ a;
        c += b, b = std::rotl(b, 17) ^ c, c = std::rotl(c, 32);
    };
    const auto take = [&](std::uint64_t word)
    {
        d ^= word;
        round();
        a ^= word;
    };
    for (const std::uint64_t word : words) take(word);
    take(std::uint64_t(8 * N) << 56);
    c ^= 0xff;
    for (int k = 0; k < 3; ++k) round();
    return a ^ b ^ c ^ d;
}

/// The bits of a point, of which 0 and -0 are the same.
inline std::array<std::uint64_t, 3> bits_of(const vec3& p)
{
    const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x == 0 ? 0.0 : x); };
    return {bits(p.x), bits(p.y), bits(p.z)};
}

} // namespace taut::impl
