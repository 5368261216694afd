// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <taut/surface_file.hpp>

#include "shared/options.hpp"
#include "shared/progress.hpp"

/// Options that several commands have.
namespace taut::tools
{

/// --format of a surface to read
void add_format(const subcommand& app, io::surface_format& format);

/// --picture of a volume or a planar mesh, and --clip
void add_drawing(const subcommand& app, std::string& picture, std::string& clip, const std::string& help);

/// --fix: groups of a volume
void add_fix(const subcommand& app, std::vector<std::string>& groups);

/// --zone of a SU2 file
void add_zone(const subcommand& app, int& zone);

/// --refine and --refined-map of a volume or a planar mesh
void add_refine(const subcommand& app, bool& refine, std::string& map, const std::string& help);

void add_device(const subcommand& app, std::string& device);
void add_time_limit(const subcommand& app, double& seconds, const std::string& help);

/// --progress and --quiet
void add_progress(const subcommand& app, std::string& progress, bool& quiet);

/// --quiet hides what nobody asked for; a --progress that is named stays.
progress_mode progress_of(const std::string& progress, bool quiet);

} // namespace taut::tools
