// SPDX-License-Identifier: MIT
#pragma once

#include "check/check_report.hpp"
#include "volume/volume_case.hpp"

namespace taut::tools
{

/// Reports the content of a volume or planar file: kinds of cells, groups, unreferenced vertices.
void report_contents(check_report& report, const io::volume_file& file);

/// Reports the faults and shape qualities of its cells.
template <class Element>
void report_cells(check_report& report, const volume_case<Element>& input);

} // namespace taut::tools
