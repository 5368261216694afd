// SPDX-License-Identifier: MIT
#include <random>
#include <set>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/certify.hpp>
#include <taut/impl/core/core/single.hpp>
#include <taut/impl/core/exact/mend_rounding.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;

template <int D>
bool in_single_precision(const std::vector<vec<D>>& x)
{
    for (const auto& p : x)
        for (int k = 0; k < D; ++k)
            if (in_single(p[k]) != p[k]) return false;
    return true;
}

} // namespace

TEST_CASE("rounding: cells some units of the last digit large are mended, and what is held stays")
{
    std::mt19937 random(3);
    std::size_t flat = 0, left = 0;
    for (const double far : {0x1p21, 0x1p22})
        for (int round = 0; round < 10; ++round)
        {
            const auto m = test::grid(12, 12);
            std::uniform_real_distribution<double> shift(-0.3, 0.3);
            std::vector<vec2> x;
            std::set<idx> held;
            for (std::size_t v = 0; v < m.points().size(); ++v)
            {
                const vec3& p = m.points()[v];
                const bool inside = p.x > 0.01 && p.x < 0.99 && p.y > 0.01 && p.y < 0.99;
                if (!inside) held.insert(static_cast<idx>(v));
                x.push_back(12.0 * vec2(p) + (inside ? vec2(shift(random), shift(random)) : vec2(0.0)) + vec2(far));
            }
            if (!certify<2>(m.cells(), std::span<const vec2>(x))) continue;
            for (auto& p : x)
                for (int k = 0; k < 2; ++k) p[k] = in_single(p[k]);
            const auto before = certify<2>(m.cells(), std::span<const vec2>(x)).flipped;
            const auto rounded = x;
            mend_rounding<2>(std::span(m.cells()), std::span<vec2>(x),
                             [&](std::size_t v, int) { return !held.contains(static_cast<idx>(v)); });
            const auto after = certify<2>(m.cells(), std::span<const vec2>(x)).flipped;
            CHECK(after <= before);
            CHECK(in_single_precision<2>(x));
            for (const idx v : held) CHECK(x[static_cast<std::size_t>(v)] == rounded[static_cast<std::size_t>(v)]);
            if (before == 0) CHECK(x == rounded);
            flat += before;
            left += after;
        }
    CHECK(flat > 20);
    CHECK(20 * left < flat);
}
