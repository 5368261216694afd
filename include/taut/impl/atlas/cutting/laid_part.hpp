// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/atlas/cutting/flat_surface.hpp>
#include <taut/impl/atlas/surface_part.hpp>

namespace taut::impl
{

/// Charts of a surface as they lie in the plane.
struct laid_seams
{
    std::vector<char>& seam;   ///< one a side of the surface
    std::vector<vec2>& uv;     ///< one a corner
    std::span<const idx> some; ///< triangles of whole charts, ascending: what is changed
    bool whole = true;         ///< their maps may follow as a whole
};

/// Some charts of a surface by themselves, with their maps.
struct laid_part
{
    surface_part part;
    rest_surface rest;
    flat_surface flat;

    /// kept: sides that stay seams, or empty; factors: what a unit of length of a seam counts along each side, or empty
    static laid_part of(const mesh<triangle>& m, const laid_seams& laid, std::span<const char> kept,
                        std::span<const double> factors)
    {
        std::vector<char> given(kept.begin(), kept.end());
        given.resize(3 * m.cells().size(), 0);
        surface_part part = part_of(m, laid.some, given);
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
        return {std::move(part), std::move(rest), std::move(flat)};
    }

    /// Gives seams and maps back to the surface.
    void write(const laid_seams& laid) const
    {
        for (std::size_t s = 0; s < flat.seam.size(); ++s)
        {
            if (rest.facets.twin[s] >= 0) laid.seam[part.origin(s)] = flat.seam[s];
            laid.uv[part.origin(s)] = flat.uv[s];
        }
    }
};

} // namespace taut::impl
