// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/core/csr.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

inline std::size_t usize(idx i)
{
    return static_cast<std::size_t>(i);
}

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

/// Returns whether a triangle contains an upright square, by more than what single precision rounds.
inline bool contains_square(const std::array<vec2, 3>& t, const vec2& centre, double half)
{
    double largest = 0;
    for (const vec2& p : t) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    const double margin = 0.02 + 1e-6 * largest;
    const auto cross = [](const vec2& a, const vec2& b) { return a.x * b.y - a.y * b.x; };
    const double side = cross(t[1] - t[0], t[2] - t[0]) < 0 ? -1 : 1;
    for (std::size_t k = 0; k < 3; ++k)
    {
        const vec2 d = t[(k + 1) % 3] - t[k];
        const double reach = half * (std::abs(d.x) + std::abs(d.y)) + margin * glm::length(d);
        if (!(side * cross(d, centre - t[k]) >= reach)) return false;
    }
    return true;
}

/// The tiles of a row that may still get triangles.
class open_tiles
{
public:
    open_tiles(idx across, idx down) : width_(across + 1), next_(usize(width_) * usize(down))
    {
        for (std::size_t k = 0; k < next_.size(); ++k) next_[k] = static_cast<idx>(k % usize(width_));
    }

    /// The first open one of a row from i on; as many as there are across if there is none.
    idx from(idx row, idx i)
    {
        idx* const next = &next_[usize(row) * usize(width_)];
        while (next[i] != i) i = next[i] = next[next[i]];
        return i;
    }

    void close(idx row, idx i) { ++next_[usize(row) * usize(width_) + usize(i)]; }

private:
    idx width_; // with one beyond the last
    std::vector<idx> next_;
};

/// The triangles that come nearer than `reach` to each tile of size x size, row by row of tiles, in their order, up to
/// the first one that contains the tile: those behind it are not seen. Triangles that are not finite are in none.
/// Throws parameter_error for more than 2^31 of them in all tiles together. places: of corners, in texels
inline csr triangles_by_tile(std::span<const std::array<vec2, 3>> places, idx size, idx across, idx down, double reach)
{
    std::vector<std::vector<idx>> rows(usize(across) * usize(down));
    open_tiles open(across, down);
    std::size_t count = 0;
    for (std::size_t f = 0; f < places.size(); ++f)
    {
        const auto& [a, b, c] = places[f];
        const vec2 low = glm::min(a, glm::min(b, c)) - reach, high = glm::max(a, glm::max(b, c)) + reach;
        if (!std::isfinite(low.x + low.y + high.x + high.y)) continue;
        if (high.x < 0 || high.y < 0 || low.x > size * across || low.y > size * down) continue;
        const auto tile_of = [size](double x, idx most)
        { return static_cast<idx>(std::clamp(std::floor(x / size), 0.0, static_cast<double>(most - 1))); };
        const idx first = tile_of(low.x, across), last = tile_of(high.x, across);
        for (idx j = tile_of(low.y, down); j <= tile_of(high.y, down); ++j)
            for (idx i = open.from(j, first); i <= last; i = open.from(j, i + 1))
            {
                const vec2 centre = vec2(i + 0.5, j + 0.5) * static_cast<double>(size);
                if (!near_square(places[f], centre, 0.5 * size, reach)) continue;
                rows[usize(j) * usize(across) + usize(i)].push_back(static_cast<idx>(f));
                if (++count > static_cast<std::size_t>(std::numeric_limits<idx>::max()))
                    throw parameter_error("to", "triangles lie over each other more than two thousand million times "
                                                "in all tiles; give a map without overlaps");
                if (contains_square(places[f], centre, 0.5 * size)) open.close(j, i);
            }
    }
    csr tiles{{0}, {}};
    tiles.items.reserve(count);
    for (auto& row : rows)
    {
        tiles.items.insert(tiles.items.end(), row.begin(), row.end());
        tiles.offsets.push_back(static_cast<idx>(tiles.items.size()));
        row = {};
    }
    return tiles;
}

} // namespace taut::impl
