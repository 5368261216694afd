// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace taut::tools
{

/// What - stands for on the command line.
inline constexpr const char *standard_input = "/dev/stdin", *standard_output = "/dev/stdout";

/// The files that a run is going to write, looked at before it starts: nobody waits an hour for "no such folder".
class outputs
{
public:
    /// Notes that `option` names a file to write; an empty path is no file. Throws usage_error if it cannot be written
    /// as things are (no such folder, no permission, no room, a folder of that name), if another output is the same
    /// file, or if the extension (in any case) is none of `extensions` (none: any will do). What is no file, as a pipe,
    /// needs no extension.
    void add(const std::string& option, const std::filesystem::path& path, std::vector<std::string> extensions);

    /// Throws usage_error if one of the outputs added so far is this file, under whatever name.
    /// what: "the input"; but_for: an option that may replace it.
    void protect(const std::string& what, const std::filesystem::path& input, const std::string& but_for = {}) const;

    /// Where a report for people goes: standard output, or standard error if a file goes there. Throws usage_error if
    /// that is closed.
    const char* place_of_report() const;

private:
    struct output
    {
        std::string option;
        std::filesystem::path path;
    };
    std::vector<output> outputs_;
    bool standard_output_taken_ = false;
};

/// Whether somebody may read what is written to place_of_report(): who has closed the terminal or ended the pager must
/// not lose the map.
bool has_reader(const char* place_of_report);

/// The extension in lower case, ".png".
std::string extension(const std::filesystem::path& path);

/// Where a map goes that is not valid; nowhere if the output is a device or a pipe.
std::string name_of_invalid(const std::string& output);

/// Removes what an earlier run has left under name_of_invalid().
void remove_invalid(const std::string& output);

} // namespace taut::tools
