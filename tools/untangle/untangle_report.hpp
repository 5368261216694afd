// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <taut/untangle.hpp>

#include "shared/exit_codes.hpp"
#include "untangle/untangle_options.hpp"
#include "volume/refined_case.hpp"
#include "volume/volume_case.hpp"

namespace taut::tools
{

/// Everything that a run of `taut untangle` has to say; the map itself aside, it knows no dimension.
struct untangle_report
{
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    exit_code code = exit_code::valid;
    std::string outcome; ///< "injective", "infeasible", "gave_up" or "interrupted"
    std::string reason;  ///< why there is no valid map
    std::vector<idx> ids;
    std::string written; ///< the file with the map; empty: none
    std::string device, device_label;
    std::size_t vertices = 0, elements = 0, pinned = 0;
    certificate before, after; ///< of the initial map and of the one that is written; flipped: cells of any kind
    const char* element = "";  ///< a word
    std::string cells;         ///< how many of which kind
    int dimension = 2;
    double least_det = unknown, least_relative_det = unknown; ///< of the map; unknown where nothing was solved
    std::string format;                                       ///< of a volume file; else empty
    volume_state state_before, state_after;                   ///< of a volume file
    std::string stage;
    std::optional<refined_size> refined; ///< none: no element was split
    std::vector<untangle_stage_report> stages;
    double pin_rounding = 0; ///< by which pins were moved to where the file can hold them, at most
    std::vector<std::string> notes;
    struct
    {
        double read = 0, check = 0, device = 0, solve = 0, write = 0, total = 0;
    } seconds;
};

nlohmann::ordered_json to_json(const untangle_report& report, const untangle_options& options);

/// The table for people; notes go to standard error at once.
std::string text_of(const untangle_report& report, const untangle_options& options);

} // namespace taut::tools
