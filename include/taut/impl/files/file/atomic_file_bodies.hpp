// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include <taut/files.hpp>
#include <taut/impl/files/file/file_target.hpp>

namespace taut::io::impl
{

/// Returns whether a path is written directly: a device, a pipe, an open file such as /dev/stdout. Throws io_error for
/// a folder.
inline bool is_stream(const std::filesystem::path& path)
{
    return impl::resolve_target(path).stream;
}

/// Checks that a file can be written: permission, folder, room. Changes nothing. Throws io_error.
inline void require_writable(const std::filesystem::path& path)
{
    impl::new_file::require_writable(impl::resolve_target(path));
}

} // namespace taut::io::impl
