// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/types.hpp>

namespace taut::report
{

/// A step of the way to an atlas.
struct stage
{
    std::string name;
    double seconds = 0;
    double energy = std::numeric_limits<double>::quiet_NaN(); ///< after it, area mean; NaN: there was no map yet
};

/// A number of each chart, beside those that the report works out itself.
struct chart_column
{
    std::string name;
    std::vector<double> values; ///< one a chart; NaN: not known
};

/// Content of a report. Spans are read while the report is made.
struct atlas_page
{
    std::string title;   ///< the name of the model
    std::string command; ///< by which it can be made again
    std::span<const vec3> points;
    std::span<const std::array<idx, 3>> cells; ///< vertices of each triangle
    std::span<const std::array<vec2, 3>> uv;   ///< of its corners, in tiles of side 1; NaN: in no chart
    std::span<const idx> chart;                ///< of each triangle, from 0; -1: in none
    std::span<const double> energy;            ///< of each triangle, isometric; 4: shape is kept
    std::vector<chart_column> columns;
    std::vector<std::string> repairs; ///< what was mended, a sentence each
    std::vector<stage> stages;
    std::vector<std::pair<std::string, std::string>> numbers; ///< names and values to show above all others
    idx most_triangles = 60'000;                              ///< beyond these the view is simplified
};

/// One HTML file that needs no other and no network: model and atlas side by side and linked, charts, distortion, what
/// was mended, stages. The same page gives the same bytes.
/// Throws parameter_error where the lengths do not fit together or a triangle names a vertex that is not there.
std::string atlas_report_html(const atlas_page& page);

} // namespace taut::report
