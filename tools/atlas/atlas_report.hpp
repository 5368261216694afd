// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <report/atlas_page.hpp>
#include <taut/atlas.hpp>
#include <taut/files.hpp>
#include <taut/repair.hpp>

#include "atlas/atlas_options.hpp"
#include "shared/exit_codes.hpp"

namespace taut::tools
{

/// Everything that a run of `taut atlas` says of itself.
struct atlas_run_report
{
    struct surface
    {
        std::string input, output;
        idx vertices = 0, triangles = 0; ///< of the file
        idx mapped = 0;                  ///< triangles that have a place in the atlas
        std::vector<repair_finding> repairs;
    };

    std::vector<surface> surfaces;
    std::size_t reversed_fans = 0; ///< see count_reversed_fans()
    std::vector<std::string> notes;
    std::string device, device_label;
    taut::atlas_report atlas;
    double read = 0, queue = 0, draw = 0, write = 0, total = 0; ///< seconds
    exit_code code = exit_code::valid;
};

/// As write_with_report() asks for them.
void write_stats(io::atomic_file& file, const atlas_run_report& report, const atlas_options& options);
std::string text_of(const atlas_run_report& report, const atlas_options& options);

/// For the page of --report.
std::vector<report::stage> stages(const atlas_run_report& report);
std::vector<std::pair<std::string, std::string>> numbers(const atlas_run_report& report);

/// The isometric energy of each triangle of the surface that the atlas is of, at the scale of the atlas.
std::vector<double> triangle_energies(const atlas& made, double aspect);

} // namespace taut::tools
