// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <taut/impl/core/observer.hpp>
#include <taut/impl/core/types.hpp>
#include <taut/impl/packing/pack_params.hpp>
#include <taut/impl/packing/packing_error.hpp>

namespace taut::impl
{

/// Placement of a chart: x -> scale R x + shift, R = (cosine, -sine; sine, cosine), inside the unit square of its tile.
struct chart_place
{
    double cosine = 1, sine = 0;
    double scale = 1;
    vec2 shift{0, 0};
    idx tile = 0;

    vec2 operator()(const vec2& x) const
    {
        return scale * vec2(cosine * x.x - sine * x.y, sine * x.x + cosine * x.y) + shift;
    }
};

} // namespace taut::impl

namespace taut
{

/// Packing of charts into tiles.
struct packing
{
    std::vector<impl::chart_place> places; ///< one per chart
    double scale = 0;                      ///< scale of all charts, before their densities
    double utilization = 0;                ///< area of the triangles by the area of the tiles
    int layouts = 0;                       ///< that were tried
    int resolution = 0;                    ///< texels along the width of a tile
    int tiles = 0;                         ///< in use, where pack_params::texels_per_unit is given; else all there are
    bool complete = true;                  ///< false: it was ended by the clock or the observer, and could be denser

    /// The points of all charts in their tiles, with the number of its tile added to the first coordinate of each.
    /// first_vertex: #charts + 1
    std::vector<vec2> apply(std::span<const vec2> uv, std::span<const idx> first_vertex) const
    {
        std::vector<vec2> x(uv.size());
        for (std::size_t c = 0; c < places.size(); ++c)
            for (auto v = static_cast<std::size_t>(first_vertex[c]); v < static_cast<std::size_t>(first_vertex[c + 1]);
                 ++v)
                x[v] = places[c](uv[v]) + vec2(places[c].tile, 0);
        return x;
    }
};

} // namespace taut

namespace taut::impl
{

struct chart_outlines;

/// How long a layout is looked for, where the scale is unknown.
enum class packing_effort
{
    draft,    ///< to tell the good ones of many sets of charts
    estimate, ///< to compare two sets of charts, within some hundredths
    full
};

/// Packs charts with known borders in these coordinates. enough: use of the tiles beyond which no better layout is
/// looked for
packing pack_outlined(std::span<const vec2> uv, const chart_outlines& outlines, const pack_params& params,
                      const run_limits& limits, packing_effort effort = packing_effort::full,
                      double enough = std::numeric_limits<double>::infinity());

} // namespace taut::impl

namespace taut
{

/// Packs charts into squares: all at one scale, as large as is found, rotated and translated, never mirrored, also into
/// the gaps, concavities and holes of each other. The same input gives the same layout whatever the number of threads.
///
/// uv:           #V points in any one unit, finite
/// cells:        their triangles; a chart that is folded, or overlaps itself, excludes others from all that it covers
/// first_cell:   #charts + 1: the triangles of a chart are in one piece
/// first_vertex: #charts + 1: so are its vertices
///
/// limits:       then the best layout so far is returned; a cheap one on shelves is made first. The observer is asked
///               every 8 charts of a layout
///
/// certify_packing() (packing/certificate.hpp) measures the result of any packer.
/// Throws packing_error, parameter_error.
packing pack(std::span<const vec2> uv, std::span<const std::array<idx, 3>> cells, std::span<const idx> first_cell,
             std::span<const idx> first_vertex, const pack_params& params = {}, const run_limits& limits = {});

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/packing/pack.ipp>
#endif
