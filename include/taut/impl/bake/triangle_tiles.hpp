// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/core/csr.hpp>
#include <taut/impl/core/types.hpp>

namespace taut::impl
{

/// Returns whether a triangle may come nearer to an upright square than `reach`: exact but for corners, where it may
/// say yes for a little more.
inline bool near_square(const std::array<vec2, 3>& t, const vec2& centre, double half, double reach)
{
    const double grown = half + reach;
    const auto outside = [&](const vec2& normal)
    {
        const double size = std::abs(normal.x) + std::abs(normal.y), middle = glm::dot(normal, centre);
        double low = glm::dot(normal, t[0]), high = low;
        for (const vec2& p : t)
        {
            low = std::min(low, glm::dot(normal, p));
            high = std::max(high, glm::dot(normal, p));
        }
        return low > middle + size * grown || high < middle - size * grown;
    };
    for (std::size_t k = 0; k < 3; ++k)
    {
        const vec2 d = t[(k + 1) % 3] - t[k];
        if (outside({d.y, -d.x})) return false;
    }
    return !outside({1, 0}) && !outside({0, 1});
}

/// The triangles that come nearer than `reach` to each tile of size x size, row by row of tiles, in their order.
/// Triangles that are not finite are in none. places: of corners, in texels
inline csr triangles_by_tile(std::span<const std::array<vec2, 3>> places, idx size, idx across, idx down, double reach)
{
    std::vector<std::vector<idx>> rows(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
    for (std::size_t f = 0; f < places.size(); ++f)
    {
        const auto& [a, b, c] = places[f];
        const vec2 low = glm::min(a, glm::min(b, c)) - reach, high = glm::max(a, glm::max(b, c)) + reach;
        if (!std::isfinite(low.x + low.y + high.x + high.y)) continue;
        if (high.x < 0 || high.y < 0 || low.x > size * across || low.y > size * down) continue;
        const auto tile_of = [size](double x, idx most)
        { return static_cast<idx>(std::clamp(std::floor(x / size), 0.0, static_cast<double>(most - 1))); };
        for (idx j = tile_of(low.y, down); j <= tile_of(high.y, down); ++j)
            for (idx i = tile_of(low.x, across); i <= tile_of(high.x, across); ++i)
                if (near_square(places[f], vec2(i + 0.5, j + 0.5) * static_cast<double>(size), 0.5 * size, reach))
                    rows[static_cast<std::size_t>(j) * static_cast<std::size_t>(across) + static_cast<std::size_t>(i)]
                        .push_back(static_cast<idx>(f));
    }
    csr tiles{{0}, {}};
    for (const auto& row : rows)
    {
        tiles.items.insert(tiles.items.end(), row.begin(), row.end());
        tiles.offsets.push_back(static_cast<idx>(tiles.items.size()));
    }
    return tiles;
}

} // namespace taut::impl
