// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <taut/impl/core/types.hpp>
#include <taut/impl/exact/certify.hpp>

namespace taut::impl
{

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

} // namespace taut::impl

namespace taut
{

/// Report of one run of make_atlas(): its phases and the measures of the atlas.
struct atlas_report
{
    bool complete = true;              ///< false: the clock or the observer ended it; the atlas is valid all the same
    std::string reason;                ///< why there is no valid atlas; empty if there is one
    std::vector<idx> reason_triangles; ///< those that `reason` names
    std::vector<std::string> notes;    ///< decisions of the library
    std::vector<impl::chart_summary> charts; ///< in the order of chart_mesh
    certificate flips;                       ///< certificate of all triangles in the atlas, exact
    std::size_t overlaps = 0;   ///< pairs of edges of chart borders that meet, and of charts one in the other; exact
    std::size_t polygons = 0;   ///< polygons of more than three corners that are convex in space
    std::size_t concave = 0;    ///< those of them that are not convex in the atlas; exact
    double distortion = 0;      ///< area mean of the isometric energy at one common scale; 4: none
    double worst = 0;           ///< the largest of a chart
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
    std::optional<impl::atlas_symmetry> symmetry; ///< with atlas_params::symmetric
    impl::atlas_seconds seconds;

    /// "the chart of triangle 7", for the reason.
    std::string name_chart(idx triangle)
    {
        reason_triangles.push_back(triangle);
        return "the chart of triangle " + std::to_string(triangle);
    }
};

/// "17 charts, E 4.031, 76 % of the square, 0 flipped, 0 overlaps"
inline std::ostream& operator<<(std::ostream& out, const atlas_report& r)
{
    if (!r.reason.empty()) return out << "no valid atlas: " << r.reason;
    return out << r.charts.size() << (r.charts.size() == 1 ? " chart, E " : " charts, E ") << r.distortion << ", "
               << static_cast<int>(100 * r.utilization) << " % of the square, " << r.flips.flipped << " flipped, "
               << r.overlaps << " overlaps";
}

} // namespace taut
