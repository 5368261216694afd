// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <taut/parameterize.hpp>

#include "shared/assessment.hpp"
#include "shared/exit_codes.hpp"
#include "unwrap/unwrap_options.hpp"

namespace taut::tools
{

/// Wall-clock seconds of the phases that the library does not see.
struct program_seconds
{
    double read = 0, queue = 0, quality = 0, draw = 0, write = 0, total = 0;
};

/// Everything that a run of `taut unwrap` has to say.
struct unwrap_report
{
    exit_code code = exit_code::valid;
    std::string device, device_label;
    std::vector<std::string> notes;
    std::size_t pins = 0, springs = 0; ///< vertices that have one
    std::size_t seam_vertices = 0;     ///< vertices of the file along which it was cut open
    map_report map;
    impl::means energy_end;               ///< of the energy that was minimised, in double on the host
    double energy_before = 0, energy = 0; ///< at the start and at the end, by the chosen weights
    assessment after;
    program_seconds seconds;

    /// Fills the energies, `after`, and the exit code from the reason of the stop. After an interruption nothing is
    /// measured but flips.
    void assess(const unwrap_options& options, const parameterize_params& params, const mesh<triangle>& surface,
                std::span<const vec2> uv);

    /// "isometric, free boundary; gradient after 12 iterations": for the picture.
    std::string summary() const { return summary_; }

private:
    std::string summary_;
};

nlohmann::ordered_json to_json(const unwrap_report& report, const unwrap_options& options);

/// The table for people; notes go to standard error at once.
std::string text_of(const unwrap_report& report, const unwrap_options& options);

} // namespace taut::tools
