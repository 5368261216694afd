// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/hierarchy/reinsert.hpp>
#include <taut/impl/core/hierarchy/relax_stars.hpp>

namespace taut::impl
{

/// Parameters of prolonging a map to the next finer level.
struct raise_params
{
    std::span<const char> fixed = {}; ///< flags of vertices that stay, one per vertex of the finest level, or none
    double factor = 3;                ///< triangles with so many times the mean energy are improved afterwards
    int sweeps = 6;                   ///< over their vertices, at most
    unsigned threads = 0;
};

/// Scales a map of a level with positive triangles to minimum isometric energy. Where rounding would flip a triangle,
/// by the nearest power of two.
inline void scale_to_fit(const hierarchy<triangle>& h, std::size_t level, std::span<const vec3> points,
                         std::vector<vec2>& uv, unsigned threads = 0)
{
    const double scale = isometric_scale(h, level, points, uv, threads);
    const auto& cells = h.levels[level].cells;
    const auto scaled = [&](idx v) { return scale * uv[static_cast<std::size_t>(v)]; };
    const auto turned = block_sum<int>(
        cells.size(),
        [&](int& count, std::size_t c)
        { count += !surely_positive(scaled(cells[c][0]), scaled(cells[c][1]), scaled(cells[c][2])); },
        threads);
    const double factor = turned == 0 ? scale : std::exp2(std::round(std::log2(scale)));
    for (vec2& p : uv) p *= factor;
}

/// Map of a level.
struct raised_map
{
    std::vector<vec2> uv;
    relaxed_energy energy; ///< before: as the vertices came back
};

/// Prolongs a map of the next coarser level: vertices are reinserted, then those of the worst triangles, old and new,
/// are improved one by one. Where some have no valid position, the coarse map is improved as a whole and it is tried
/// again; the last attempt is returned.
inline raised_map raise_map(const hierarchy<triangle>& h, std::size_t level, std::span<const vec3> points,
                            std::vector<vec2> coarse, const raise_params& params)
{
    const auto relax = [&](std::size_t at, std::vector<vec2>& uv, double factor, int sweeps)
    {
        const auto& l = h.levels[at];
        std::vector<char> fixed;
        if (!params.fixed.empty())
            for (const idx v : l.vertices) fixed.push_back(params.fixed[static_cast<std::size_t>(v)]);
        if (fixed.empty()) scale_to_fit(h, at, points, uv, params.threads);
        return star_relaxation(points, l.vertices, l.cells, fixed, params.threads).run(uv, factor, sweeps);
    };
    constexpr int attempts = 3;
    for (int attempt = 1;; ++attempt)
    {
        reinsertion fine = reinsert(h, level, points, coarse, {.threads = params.threads});
        if (fine.failed.empty() || attempt == attempts)
        {
            const auto energy = relax(level, fine.uv, params.factor, params.sweeps);
            return {std::move(fine.uv), energy};
        }
        relax(level + 1, coarse, 0, 10 * attempt);
    }
}

} // namespace taut::impl
