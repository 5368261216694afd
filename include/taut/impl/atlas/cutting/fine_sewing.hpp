// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/atlas/cutting/sew_tips.hpp>
#include <taut/impl/atlas/surface_part.hpp>

namespace taut::impl
{

/// Charts of a surface as they lie in the plane.
struct laid_seams
{
    std::vector<char>& seam;   ///< one a side of the surface
    std::vector<vec2>& uv;     ///< one a corner
    std::span<const idx> some; ///< triangles of whole charts, ascending: what may be sewn up
    bool whole = true;         ///< their maps may follow as a whole
};

/// Sews up seams of charts that have a map, on the surface itself, until they are at a bound of their mean energy.
/// kept: sides that stay seams, or empty; factors: what a unit of length of a seam counts along each side, or empty
/// Returns whether something has changed.
inline bool sew_laid(const mesh<triangle>& m, const laid_seams& laid, std::span<const char> kept, double bound,
                     const std::function<bool()>& proceed, std::span<const double> factors = {})
{
    std::vector<idx> number(m.points().size(), -1);
    std::vector<char> given(kept.begin(), kept.end());
    given.resize(3 * m.cells().size(), 0);
    const surface_part part = part_of(m, laid.some, given, number);
    rest_surface rest = rest_surface::of(part.charts.surface, part.charts.surface.cell_count());
    if (!factors.empty())
        for (std::size_t s = 0; s < rest.price.size(); ++s) rest.price[s] *= factors[part.origin(s)];
    flat_surface flat;
    flat.seam.resize(rest.facets.twin.size(), 0);
    flat.uv.resize(flat.seam.size());
    for (std::size_t s = 0; s < flat.seam.size(); ++s)
    {
        flat.seam[s] = laid.seam[part.origin(s)] && rest.facets.twin[s] >= 0;
        flat.uv[s] = laid.uv[part.origin(s)];
    }
    number_fans(rest, flat);
    flat.energy = mean_energy(rest, flat.uv);
    constexpr idx most = 16'000; // triangles of which the whole map may follow
    const bool whole = laid.whole && rest.triangles() <= most;
    const auto before = seam_price(rest, flat.seam);
    const sewing how{.bound = bound,
                     .patch = whole ? std::size_t{120} : std::size_t{300},
                     .keep_apart = true,
                     .whole = whole,
                     .proceed = proceed,
                     .told = {}};
    tip_sewing(rest, flat, how).run();
    if (!(seam_price(rest, flat.seam) < before)) return false;
    for (std::size_t s = 0; s < flat.seam.size(); ++s)
    {
        if (rest.facets.twin[s] >= 0) laid.seam[part.origin(s)] = flat.seam[s];
        laid.uv[part.origin(s)] = flat.uv[s];
    }
    return true;
}

} // namespace taut::impl
