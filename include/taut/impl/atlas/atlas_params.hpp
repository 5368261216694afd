// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <vector>

#include <taut/impl/atlas/flatten_charts.hpp>
#include <taut/impl/atlas/seams/seam_factors.hpp>
#include <taut/impl/atlas/segment.hpp>
#include <taut/impl/packing/pack_params.hpp>

namespace taut
{

/// Purpose of the charts of an atlas.
enum class chart_preference
{
    seams,   ///< few charts along short seams
    packing, ///< charts that fill squares well: more of them
    one      ///< one chart a component, where it can be
};

/// Parameters of make_atlas(). Every field has a sensible default.
struct atlas_params
{
    /// How far charts go, and seams that are given. 4.1 is a stretch (L2) of 1.017; for packing, 4.2 and 4.045, the
    /// bounds of segment_params, are good.
    segment_params charts = {.max_distortion = std::numeric_limits<double>::infinity(), .mean_distortion = 4.1};

    chart_preference prefer = chart_preference::seams;

    /// Where seams are liked. Not of charts that are kept; weights are not for `symmetric`.
    impl::seam_wishes wishes = {};

    /// True if the charts are those separated by `charts.seams`: they are flattened, from `initial` if it is given, and
    /// packed.
    bool keep_charts = false;

    /// False if kept charts are laid as they are in `initial`, moved, turned and scaled to one texel density alone. One
    /// that is mirrored there is mirrored back.
    bool relax = true;

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

    /// The tile that each triangle's chart is to be in, one number each, or empty. Charts cross from one to another no
    /// further than `charts.seams` lets them: give the borders of groups as seams.
    std::vector<idx> groups = {};

    /// True if charts that are copies of each other in space, turned and moved, lie on each other: each is a copy of
    /// the first one's map. They do not count as overlaps.
    bool stack = false;

    pack_params packing = {}; ///< its limits are overruled

    /// Lower left corner of the first tile, integers. {0, -1} is for files whose v runs downwards: their coordinates
    /// are (u, -v), which is exact where 1 - v is not.
    vec2 origin = vec2(0.0);

    /// Rounding of coordinates by the file format, such as to floats: the certificate is of the results. Null: none.
    vec2 (*stored)(vec2) = nullptr;

    /// Limits of the whole call. Parts without a valid map by then fall back to planar-projection charts. The observer
    /// is asked several times a second: progress::stage names the stage, progress::iteration counts the charts that are
    /// done in it, progress::value is the mean energy of these, or the use of the squares.
    run_limits limits = {};
};

} // namespace taut
