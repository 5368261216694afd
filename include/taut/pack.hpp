// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_PACKING
#endif
#ifndef TAUT_PACK_HPP
#define TAUT_PACK_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/charts/packing/chart_overlaps.hpp>
#include <taut/options.hpp>
#include <taut/types.hpp>

/// Packs charts into tiles, and certifies packings from any packer.
namespace taut
{

/// An edge of a closed outline in a tile, [0, 1]², with what is enclosed to its left.
struct tile_wall
{
    idx tile = 0;
    std::array<vec2, 2> edge;
};

/// Parameters of pack().
struct pack_params
{
    /// Texels along a side of a tile, 1 to 65536: the unit of `padding`.
    int resolution = 1024;

    /// Minimum distance in texels between two charts, and between a chart and the border of its tile; at least 0.
    double padding = 2;

    /// Number of tiles, 1 to 1000, filled as evenly as charts allow. All charts have one scale.
    int tiles = 1;

    /// Height of a tile by its width, a power of two from 1/16 to 16: 0.5 is 2048 x 1024 for a resolution of 2048,
    /// which is of the width. Places are in widths: a tile is [0, 1] x [0, aspect].
    double aspect = 1;

    /// Texels of a unit of length in charts; 0: as many as fit. Then `tiles` is a maximum: as few are used as charts
    /// take.
    double texels_per_unit = 0;

    /// With texels_per_unit: the resolution is doubled until all charts fit into `tiles`, up to this; 0: it is not.
    int max_resolution = 0;

    /// Side of the blocks of texels that belong to one chart each, such as 4 for compressed textures; the boxes of
    /// charts begin at blocks. A power of two, 1 to 64; 1: none.
    int align = 1;

    /// The tile of each chart; empty: any. Of make_atlas() that of each triangle's chart: charts cross from one tile to
    /// another no further than `charts.seams` lets them, so give the borders of groups as seams.
    std::vector<idx> groups = {};

    /// True if charts may be rotated. Otherwise they are only translated and scaled.
    bool rotate = true;

    /// Relative texel densities: factors of the lengths of charts, more texels for a face, fewer for a sole. One
    /// positive number per chart, of make_atlas() per triangle, the same within a chart; empty: 1 each.
    std::vector<double> densities = {};

    /// Obstacles in the tiles, from which charts keep the padding.
    std::vector<tile_wall> walls = {};

    /// Maximum rounding of a coordinate in [0, tiles) in the output file; the padding is kept after it. Default:
    /// floats, tiles up to the eighth. 0 to 0.001.
    double rounding = 1e-6;

    /// Throws parameter_error.
    void validate(idx charts) const
    {
        const auto require = [](bool holds, const char* name, const char* range)
        {
            if (!holds) throw parameter_error(name, std::string("must be ") + range);
        };
        require(resolution >= 1 && resolution <= 65536, "resolution", "1 to 65536");
        require(padding >= 0 && padding <= std::numeric_limits<double>::max(), "padding", "at least 0 and finite");
        require(2 * padding < resolution, "padding", "less than half the resolution");
        require(tiles >= 1 && tiles <= 1000, "tiles", "1 to 1000");
        require(aspect >= 1.0 / 16 && aspect <= 16 && std::exp2(std::round(std::log2(aspect))) == aspect, "aspect",
                "a power of two from 1/16 to 16");
        require(2 * padding < resolution * aspect, "padding", "less than half the height of a tile");
        require(texels_per_unit >= 0 && texels_per_unit <= std::numeric_limits<double>::max(), "texels_per_unit",
                "at least 0 and finite");
        require(max_resolution == 0 || (max_resolution <= 65536 && texels_per_unit > 0), "max_resolution",
                "0, or up to 65536 with texels_per_unit");
        require(align >= 1 && align <= 64 && (align & (align - 1)) == 0 &&
                    8 * align <= resolution * std::min(1.0, aspect),
                "align", "a power of two from 1 to 64, an eighth of a tile at most");
        require(groups.empty() || groups.size() == static_cast<std::size_t>(charts), "groups",
                "empty or one tile a chart");
        for (const idx tile : groups) require(tile >= 0 && tile < tiles, "groups", "numbers of tiles");
        require(rounding >= 0 && rounding <= 1e-3, "rounding", "0 to 0.001");
        require(densities.empty() || densities.size() == static_cast<std::size_t>(charts), "densities",
                "empty or one number a chart");
        for (const tile_wall& wall : walls)
            for (const vec2& p : wall.edge)
                require(wall.tile >= 0 && wall.tile < tiles && p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1, "walls",
                        "within the tiles");
        for (const double d : densities)
            require(d > 0 && d <= std::numeric_limits<double>::max(), "densities", "positive and finite");
    }

    /// Whether charts are placed on a grid of cells of one size: where tiles, scale or blocks are given.
    bool on_grid() const { return aspect != 1 || texels_per_unit > 0 || align > 1 || !groups.empty(); }
};

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

/// Packing of charts into tiles.
struct packing
{
    std::vector<chart_place> places; ///< one per chart
    double scale = 0;                ///< scale of all charts, before their densities
    double utilization = 0;          ///< area of the triangles by the area of the tiles
    int layouts = 0;                 ///< that were tried
    int resolution = 0;              ///< texels along the width of a tile
    int tiles = 0;                   ///< in use, where pack_params::texels_per_unit is given; else all there are
    bool complete = true;            ///< false: it was ended by the clock or the observer, and could be denser

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

/// Certificate of a packing: overlaps, distances and fill in the given coordinates.
struct packing_certificate
{
    impl::chart_overlaps overlaps; ///< exact
    /// Minimum distance of two charts in tiles, by borders, and their numbers; infinite for a single chart, 0 where
    /// borders cross. To a few ulps of the coordinates.
    double gap = std::numeric_limits<double>::infinity();
    std::array<idx, 2> nearest{-1, -1};
    /// Minimum distance of a chart to the border of its tile, negative where it crosses it, and its number.
    double border = std::numeric_limits<double>::infinity();
    idx outermost = -1;

    /// padding, resolution: as in pack_params
    bool holds(double padding, int resolution) const
    {
        const double least = padding / resolution * (1 - 1e-9);
        return overlaps.pairs == 0 && overlaps.all && gap >= least && border >= least;
    }
};

/// Certifies charts in unit squares, from any packer: the square of a chart is that of the middle of its box, so that
/// tiles may lie side by side or in UDIM's rows of ten. Pass the coordinates as written: rounded to floats or decimals,
/// and read back. O(n log n) for n edges of borders.
///
/// uv, cells, first_cell, first_vertex: as for pack()
/// pinned: charts with a given place, one flag each: distances of two of them, and of one and the border, do not count;
/// or empty
/// aspect: as in pack_params, with uv in widths of a tile
/// Throws packing_error.
packing_certificate certify_packing(std::span<const vec2> uv, std::span<const std::array<idx, 3>> cells,
                                    std::span<const idx> first_cell, std::span<const idx> first_vertex,
                                    std::span<const char> pinned = {}, double aspect = 1);

} // namespace taut

#endif
#include <taut/impl/leave.inl>
