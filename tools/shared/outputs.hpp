// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "shared/command_line.hpp"

namespace taut::tools
{

/// The files that a run is going to write, looked at before it starts: nobody waits an hour for "no such folder".
class outputs
{
public:
    /// Throws usage_error if a file cannot be written as things are (no such folder, no permission, no room, a folder
    /// of that name), has an extension, in any case, that is not for it (what is no file, as a pipe, needs none), is
    /// also another output, under whatever name, or would overwrite what is read or a file that nobody has named: one
    /// that is written beside the output may replace what belongs to the output that is there, and nothing else. And if
    /// two inputs are standard input.
    explicit outputs(std::span<const run_file> files);

    /// Stream of the report: standard output, or standard error if a file goes there. Throws usage_error if that is
    /// closed.
    const char* place_of_report() const;

private:
    bool standard_output_taken_ = false;
};

/// Returns whether somebody may read what is written to place_of_report(): who has closed the terminal or ended the
/// pager must not lose the map.
bool has_reader(const char* place_of_report);

/// The extension in lower case, ".png".
std::string extension(const std::filesystem::path& path);

/// Name of the file for an invalid map; empty if the output is a device or a pipe, or no file at all.
std::string name_of_invalid(const std::string& output);

/// Removes what an earlier run has left under name_of_invalid().
void remove_invalid(const std::string& output);

} // namespace taut::tools
