// SPDX-License-Identifier: MIT
#pragma once

#include "check/check_report.hpp"
#include "volume/volume_case.hpp"

namespace taut::tools
{

/// What a volume file, or a planar one, says: kinds of cells, groups, vertices that no cell has.
void report_contents(check_report& report, const io::volume_file& file);

/// What is wrong with its cells, and how well they are shaped.
template <class Element>
void report_cells(check_report& report, const volume_case<Element>& input);

} // namespace taut::tools
