// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <vector>

#include <taut/impl/atlas/flatten_charts.hpp>
#include <taut/impl/atlas/segment.hpp>
#include <taut/impl/packing/pack_params.hpp>

namespace taut
{

/// Purpose of the charts of an atlas, or which are kept.
enum class chart_preference
{
    seams,   ///< few charts along short seams
    packing, ///< charts that fill squares well: more of them
    one,     ///< one chart a component, where it can be
    kept,    ///< those separated by `charts.seams`, flattened from `initial` if it is given
    laid ///< those charts as they are in `initial`, moved, turned and scaled to one texel density alone; one that is
         ///< mirrored there is mirrored back
};

/// Parameters of make_atlas(). Every field has a sensible default.
struct atlas_params
{
    /// How far charts go, and seams that are given. 4.1 is a stretch (L2) of 1.017; for packing, 4.2 and 4.045, the
    /// bounds of segment_params, are good.
    segment_params charts = {.max_distortion = std::numeric_limits<double>::infinity(), .mean_distortion = 4.1};

    chart_preference prefer = chart_preference::seams;

    /// How much seams avoid what is seen from outside, 0 to 1: 0.5 counts a length in a deep hollow about half, 1 next
    /// to nothing. Occlusion is computed by rays from each vertex. Seams of charts that are kept stay where they are.
    double hide_seams = 0;

    /// Edges that are bent by more than this, in degrees from 0 to 180, count a quarter as seams, and concave ones an
    /// eighth; 180: none. `charts.weights` are further factors, from 0.001 to 1000; not for `symmetric` or `pinned`.
    double crease_angle = 180;

    /// Initial map of kept and pinned charts, or their final one, one coordinate per corner; or empty.
    std::vector<std::array<vec2, 3>> initial = {};

    /// Triangles that are pinned at `initial`, bit for bit: one flag each, or empty. They are charts of their own,
    /// separated along the seams of `initial`; all others are packed around them. Their map has no flips or overlaps,
    /// and lies in the tiles.
    std::vector<char> pinned = {};

    /// True if charts are mirror images of each other, in a plane that is detected (symmetry.hpp); none crosses it,
    /// except those of polygons across it. Not together with charts that are kept or pinned. make_atlas() throws
    /// symmetry_error where there is no such plane.
    bool symmetric = false;

    /// True if charts that are copies of each other in space, turned and moved, lie on each other: each is a copy of
    /// the first one's map. They do not count as overlaps.
    bool stack = false;

    pack_params packing = {};

    /// Lower left corner of the first tile, integers. {0, -1} is for files whose v runs downwards: their coordinates
    /// are (u, -v), which is exact where 1 - v is not.
    vec2 origin = vec2(0.0);

    /// Rounding of coordinates by the file format, such as to floats: the certificate is of the results. Null: none.
    vec2 (*stored)(vec2) = nullptr;

    /// Returns whether charts are kept.
    bool keeps_charts() const { return prefer == chart_preference::kept || prefer == chart_preference::laid; }
};

} // namespace taut
