// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace taut::tools
{

/// The files that a run is going to write, looked at before it starts: nobody waits an hour for "no such folder".
class outputs
{
public:
    /// Notes that `option` names a file to write; an empty path is no file. Throws usage_error if the folder is missing
    /// or not writable, if the path is a folder, if another output has the same path, or if the extension (in any case)
    /// is none of `extensions` (none: any will do). Devices and pipes need no extension.
    void add(const std::string& option, const std::filesystem::path& path, std::vector<std::string> extensions);

    /// Throws usage_error if one of the outputs added so far is this input.
    void protect(const std::filesystem::path& input) const;

private:
    struct output
    {
        std::string option;
        std::filesystem::path path;
    };
    std::vector<output> outputs_;
};

/// The extension in lower case, ".png".
std::string extension(const std::filesystem::path& path);

/// False for what exists and is no regular file: a device, a pipe, a folder.
bool names_a_file(const std::filesystem::path& path);

/// Writes a text file, whole or not at all. Throws io::io_error.
void write_text(const std::filesystem::path& path, std::string_view text);

} // namespace taut::tools
