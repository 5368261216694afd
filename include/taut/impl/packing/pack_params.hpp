// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <taut/impl/core/error.hpp>
#include <taut/impl/core/types.hpp>

namespace taut::impl
{

/// An edge of a closed outline in a tile, [0, 1]², with what is enclosed to its left.
struct tile_wall
{
    idx tile = 0;
    std::array<vec2, 2> edge;
};

} // namespace taut::impl

namespace taut
{

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
    std::vector<impl::tile_wall> walls = {};

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
        for (const impl::tile_wall& wall : walls)
            for (const vec2& p : wall.edge)
                require(wall.tile >= 0 && wall.tile < tiles && p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1, "walls",
                        "within the tiles");
        for (const double d : densities)
            require(d > 0 && d <= std::numeric_limits<double>::max(), "densities", "positive and finite");
    }

    /// Whether charts are placed on a grid of cells of one size: where tiles, scale or blocks are given.
    bool on_grid() const { return aspect != 1 || texels_per_unit > 0 || align > 1 || !groups.empty(); }
};

} // namespace taut
