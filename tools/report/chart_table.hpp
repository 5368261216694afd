// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "report/atlas_page.hpp"

namespace taut::report
{

/// Charts in numbers: first `triangles`, `area` (of all charts, in per cent), `energy` (area mean) and `worst` (the
/// largest energy), then the columns of the page.
/// Throws parameter_error where a column has another length, or a triangle a chart below -1.
std::vector<chart_column> chart_table(const atlas_page& page);

/// Bounds of the histogram, as energy / 4 - 1: what is below tells maps of good atlases no longer apart.
constexpr double least_excess = 1e-4, most_excess = 9;

/// Histogram of distortion by area: fractions of the area of all charts, by the logarithm of energy / 4 - 1, in equal
/// steps between the two bounds; a first one for what is below, and a last one for what is beyond or not known.
std::vector<double> histogram(const atlas_page& page, int steps);

} // namespace taut::report
