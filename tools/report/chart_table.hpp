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

/// Histogram of distortion by area: fractions of the area of all charts, by the logarithm of energy / 4, in equal steps
/// from 1 to `highest`, and a last one for what is beyond or not known.
std::vector<double> histogram(const atlas_page& page, int steps, double highest);

} // namespace taut::report
