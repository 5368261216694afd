// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_ATLAS
#endif
#ifndef TAUT_ATLAS_HPP
#define TAUT_ATLAS_HPP

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <taut/certify.hpp>
#include <taut/charts.hpp>
#include <taut/options.hpp>
#include <taut/pack.hpp>
#include <taut/types.hpp>

/// Atlases: a surface cut into charts, flattened, packed and certified.
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
    /// bounds of segment_params, are good. `{.charts = {.seams = s}}` has the bounds of segment_params: name both, or
    /// assign `charts.seams` alone.
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

/// Summary of one chart of an atlas.
struct chart_summary
{
    idx triangles = 0;
    idx tile = 0;
    double area = 0;                                         ///< area of its triangles in space
    double energy = std::numeric_limits<double>::infinity(); ///< area mean of the isometric energy, 4 at least
};

/// Wall-clock seconds of the stages of one run.
struct atlas_seconds
{
    double setup = 0;   ///< validation
    double charts = 0;  ///< pieces and their borders
    double flatten = 0; ///< all charts, as often as they were tried
    double pack = 0;
    double certify = 0;
};

/// Plane of symmetry of a surface, and counts of its charts.
struct atlas_symmetry
{
    vec3 normal{0.0};
    double offset = 0; ///< the plane has the points x with dot(normal, x) = offset
    idx pairs = 0;     ///< pairs of charts that are mirror images
    idx own = 0;       ///< charts that are their own mirror image
};

/// Report of one run of make_atlas(): its phases and the measures of the atlas.
struct atlas_report
{
    bool complete = true;              ///< false: the clock or the observer ended it; the atlas is valid all the same
    std::string reason;                ///< why there is no valid atlas; empty if there is one
    std::vector<idx> reason_triangles; ///< those that `reason` names
    std::vector<std::string> notes;    ///< decisions of the library
    std::vector<chart_summary> charts; ///< in the order of chart_mesh
    certificate flips;                 ///< certificate of all triangles in the atlas, exact
    std::size_t overlaps = 0;   ///< pairs of edges of chart borders that meet, and of charts one in the other; exact
    std::size_t polygons = 0;   ///< polygons of more than three corners that are convex in space
    std::size_t concave = 0;    ///< those of them that are not convex in the atlas; exact
    double distortion = 0;      ///< area mean of the isometric energy at one common scale; 4: none
    double worst = 0;           ///< the largest of a chart, each at its own best scale: may be below `distortion`
    double stretch_l2 = 1;      ///< of Sander et al. 2001, at one common scale that keeps the area; 1: none
    double stretch_linf = 1;    ///< the same, the largest of a triangle
    double area_distortion = 1; ///< area mean of max(a, 1 / a), a the ratio of areas, both of one total; 1: none
    double area_difference = 0; ///< sum of the differences of areas, both of total 1 (Shay et al. 2022); 0: none
    double density_spread = 0;  ///< standard deviation by area of the texel density, by its mean; 0: none
    double area = 0;            ///< of the surface that has charts
    double utilization = 0;     ///< area of the triangles by the area of the tiles
    double seam_length = 0;     ///< length of the edges inside the surface that were cut, in its units
    std::optional<double> seen_seam; ///< part of the seams seen from outside, by length, with seam_wishes::hide
    double least_distance = 0; ///< minimum distance of two charts, or of a chart and the border of its tile, in texels
    idx stacked = 0;           ///< charts that lie on a copy, with atlas_params::stack
    idx tiles = 1;             ///< in use with pack_params::texels_per_unit, else all there are
    int resolution = 0;        ///< texels along the width of a tile
    std::optional<atlas_symmetry> symmetry; ///< with atlas_params::symmetric
    atlas_seconds seconds;

    /// "the chart of triangle 7", for the reason.
    std::string name_chart(idx triangle)
    {
        reason_triangles.push_back(triangle);
        return "the chart of triangle " + std::to_string(triangle);
    }
};

/// "17 charts, E 4.031, 76 % of the square, 0 flipped, 0 overlaps"
std::ostream& operator<<(std::ostream& out, const atlas_report& r);

/// Texture atlas of a surface: charts packed side by side into unit squares.
struct atlas
{
    chart_mesh charts; ///< the surface cut apart
    /// One per vertex of charts.surface; tile t is the unit square at atlas_params::origin + (t % 10, t / 10), as in
    /// UDIM.
    std::vector<vec2> uv;
    packing layout; ///< rotation, scale and translation of the charts
    atlas_report report;

    /// Texture coordinates by corner: numbers into uv, a triple for each triangle of the surface, in its order.
    std::vector<std::array<idx, 3>> corners() const
    {
        std::vector<std::array<idx, 3>> result(charts.surface.cells().size());
        for (std::size_t i = 0; i < result.size(); ++i)
            result[static_cast<std::size_t>(charts.cell_origins[i])] = charts.surface.cells()[i];
        return result;
    }

    /// The same as coordinates: those of the corners of each triangle of the surface.
    std::vector<std::array<vec2, 3>> corner_uv() const
    {
        std::vector<std::array<vec2, 3>> result;
        for (const auto& t : corners())
        {
            result.emplace_back();
            for (std::size_t k = 0; k < 3; ++k) result.back()[k] = uv[static_cast<std::size_t>(t[k])];
        }
        return result;
    }

    /// True if it is certified: no triangle is flipped, no two overlap, and charts are as far apart as asked.
    explicit operator bool() const { return report.reason.empty(); }
};

/// Makes an atlas of any surface: cuts it into charts that can be flattened within a bound of distortion, flattens all
/// of them at once on the queue's device, packs them, and certifies the result in exact arithmetic.
///
/// m: an oriented manifold without flat triangles; it may have several parts, be closed, have handles and holes.
///    repair_surface() (repair/repair_surface.hpp) makes one of other input.
/// limits: a run that they end returns the current charts, packed and certified all the same, and planar projections of
///    parts without a valid map; atlas_report::complete is false. The observer is asked several times a second:
///    progress::stage names the stage, progress::iteration counts the charts that are done in it, progress::value is
///    the mean energy of these, or the use of the squares.
/// Throws mesh_error, symmetry_error, parameter_error, device_error, build_error.
atlas make_atlas(queue& q, const mesh<triangle>& m, const atlas_params& params = {}, const run_limits& limits = {});

} // namespace taut

#endif
#include <taut/impl/leave.inl>
