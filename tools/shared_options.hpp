// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "progress.hpp"

/// Options that several commands have.
namespace taut::tools
{

/// Checks whose messages are sentences; CLI11's own write the range out to the last digit.
CLI::Validator number_that(bool (*holds)(double), const char* otherwise);
CLI::Validator whole_number();

void add_device(CLI::App& app, std::string& device);
void add_time_limit(CLI::App& app, double& seconds, const std::string& help);

/// --progress and --quiet
void add_progress(CLI::App& app, std::string& progress, bool& quiet);

/// --quiet hides what nobody asked for; a --progress that is named stays.
progress_mode progress_of(const std::string& progress, bool quiet);

} // namespace taut::tools
