// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <taut/io/read_surface.hpp>

#include "outputs.hpp"
#include "progress.hpp"

/// Options that several commands have.
namespace taut::tools
{

/// Checks whose messages are sentences; CLI11's own write the range out to the last digit.
CLI::Validator number_that(bool (*holds)(double), const char* otherwise);
CLI::Validator whole_number();

/// The name of a file, or of several; - stands for `stream`, standard_input or standard_output.
CLI::Option* add_path(CLI::App& app, const std::string& name, std::string& path, const char* stream,
                      const std::string& help);
CLI::Option* add_path(CLI::App& app, const std::string& name, std::vector<std::string>& paths, const char* stream,
                      const std::string& help);

/// Throws usage_error if both are standard input.
void require_one_standard_input(const std::string& input, const std::string& pins);

/// --format of a surface to read
void add_format(CLI::App& app, io::surface_format& format);

/// --picture of a volume or a planar mesh, and --cut
void add_drawing(CLI::App& app, std::string& picture, std::string& cut, const std::string& help);

/// --fix: groups of a volume
void add_fix(CLI::App& app, std::vector<std::string>& groups);

/// --refine and --refined-map of a volume or a planar mesh
void add_refine(CLI::App& app, bool& refine, std::string& map, const std::string& help);

void add_device(CLI::App& app, std::string& device);
void add_time_limit(CLI::App& app, double& seconds, const std::string& help);

/// --progress and --quiet
void add_progress(CLI::App& app, std::string& progress, bool& quiet);

/// --quiet hides what nobody asked for; a --progress that is named stays.
progress_mode progress_of(const std::string& progress, bool quiet);

} // namespace taut::tools
