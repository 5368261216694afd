// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "shared/options.hpp"

namespace taut::tools
{

/// Treatment of the boundary of a volume file while it is untangled.
enum class untangle_boundary
{
    automatic, ///< unless something else is held
    fixed,
    free
};

/// Options of `taut untangle`.
struct untangle_options
{
    std::string input, output, stats, picture, device, progress;
    std::string rest, pins, clip;   ///< of volume files
    std::vector<std::string> fixed; ///< groups
    untangle_boundary boundary = untangle_boundary::automatic;
    double time_limit = std::numeric_limits<double>::infinity();
    bool quiet = false, refine = false;
    int zone = 0;            ///< of a SU2 file of several; 0: none
    std::string refined_map; ///< a table of what elements are parts of; empty: none
};

/// Declares the options; they are filled when the program's arguments are parsed.
void declare(const subcommand& app, untangle_options& options);

/// Throws usage_error for options that do not fit together.
void check(const untangle_options& options);

} // namespace taut::tools
