// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <taut/impl/io/read_surface.hpp>

#include "shared/command_line.hpp"
#include "shared/progress.hpp"

/// Options that several commands have.
namespace taut::tools
{

/// Checks whose messages are sentences; CLI11's own write the range out to the last digit.
CLI::Validator number_that(bool (*holds)(double), const char* otherwise);
CLI::Validator whole_number();

/// --format of a surface to read
void add_format(CLI::App& app, io::surface_format& format);

/// --picture of a volume or a planar mesh, and --cut
void add_drawing(CLI::App& app, std::string& picture, std::string& cut, const std::string& help);

/// --fix: groups of a volume
void add_fix(CLI::App& app, std::vector<std::string>& groups);

/// --zone of a SU2 file
void add_zone(CLI::App& app, int& zone);

/// --refine and --refined-map of a volume or a planar mesh
void add_refine(CLI::App& app, bool& refine, std::string& map, const std::string& help);

void add_device(CLI::App& app, std::string& device);
void add_time_limit(CLI::App& app, double& seconds, const std::string& help);

/// --progress and --quiet
void add_progress(CLI::App& app, std::string& progress, bool& quiet);

/// --quiet hides what nobody asked for; a --progress that is named stays.
progress_mode progress_of(const std::string& progress, bool quiet);

} // namespace taut::tools
