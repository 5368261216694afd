// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <taut/errors.hpp>
#include <taut/impl/files/file/file_target.hpp>
#include <taut/impl/files/file/open_file.hpp>

namespace taut::io::impl
{

/// Of a path where a file is to be read.
inline constexpr const char* a_folder = "is a folder; name a file";

/// Null, with errno, if it cannot be opened. What is open already (/dev/stdin) is read on from where it is.
open_file open_to_read(const std::filesystem::path& path);

/// Maximum number of bytes that read_file reads by default: a quarter of the machine's memory, or of the limit of the
/// process (ulimit -v), as a device or a pipe may be endless.
std::uint64_t most_bytes_to_read();

/// Real path of a file that lies in a folder or below it, links followed; none for what leads out of it or nowhere: a
/// document of a stranger may name any file of the reader, and lie beside a link to it.
std::optional<std::filesystem::path> path_within(const std::filesystem::path& folder,
                                                 const std::filesystem::path& file);

/// All bytes of a file, of a pipe or of what is open as /dev/stdin. most: more than that is an error.
/// Throws io_error.
std::string read_file(const std::filesystem::path& path, std::uint64_t most = most_bytes_to_read());

} // namespace taut::io::impl
