// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include <taut/errors.hpp>

namespace taut::io::impl
{

/// number: an errno; more: what else there is to say.
[[noreturn]] void cannot_write(const std::filesystem::path& path, int number, const std::string& more = {});

/// The number of an open file of this process, if that is what a path names: /dev/stdin, /dev/fd/3, /proc/self/fd/3;
/// else -1. Opened anew, such a file would be read or written from its start, or not at all.
int open_file_number(const std::filesystem::path& path);

/// Target of a path to be written, with its links resolved.
struct file_target
{
    std::filesystem::path path;
    int number = -1;     ///< of a file that is open already
    bool stream = false; ///< a device, a pipe, or an open file: what is written goes into it at once
};

/// Throws io_error for a folder, and for links without end.
file_target resolve_target(std::filesystem::path path);

} // namespace taut::io::impl
