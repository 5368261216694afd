// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <taut/core/types.hpp>
#include <taut/exact/certify.hpp>

namespace taut
{

/// One chart of an atlas.
struct chart_summary
{
    idx triangles = 0;
    idx tile = 0;
    double area = 0;                                         ///< of its triangles in space
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

/// The plane of a surface that is its own mirror image, and its charts.
struct atlas_symmetry
{
    vec3 normal{0.0};
    double offset = 0; ///< the plane has the points x with dot(normal, x) = offset
    idx pairs = 0;     ///< of charts that are mirror images
    idx own = 0;       ///< charts that are their own
};

/// What one run did and what its atlas is like.
struct atlas_report
{
    bool complete = true;              ///< false: the clock or the observer ended it; the atlas is valid all the same
    std::string reason;                ///< why there is no valid atlas; empty if there is one
    std::vector<std::string> notes;    ///< what the library decided on its own
    std::vector<chart_summary> charts; ///< in the order of chart_mesh
    certificate flips;                 ///< of all triangles as they lie in the atlas, exact
    std::size_t overlaps = 0;  ///< pairs of edges of chart borders that meet, and of charts one in the other; exact
    std::size_t polygons = 0;  ///< of more than three corners that are convex in space
    std::size_t concave = 0;   ///< those that are not in the atlas; exact
    double distortion = 0;     ///< area mean of the isometric energy at one common scale; 4: none
    double worst = 0;          ///< the largest of a chart
    double stretch_l2 = 1;     ///< of Sander et al. 2001, at one common scale that keeps the area; 1: none
    double stretch_linf = 1;   ///< the same, the largest of a triangle
    double area = 0;           ///< of the surface that has charts
    double utilization = 0;    ///< area of the triangles by the area of the tiles
    double seam_length = 0;    ///< of edges inside the surface that were cut, in its units
    double least_distance = 0; ///< in texels, of two charts, or a chart and the border of its tile
    idx tiles = 1;
    std::optional<atlas_symmetry> symmetry; ///< of a run that was to have it
    atlas_seconds seconds;
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
