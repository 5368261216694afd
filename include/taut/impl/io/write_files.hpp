// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <taut/impl/io/atomic_file.hpp>

namespace taut::io
{

/// File to be written, with the function that writes its bytes.
struct file_to_write
{
    std::filesystem::path path;
    std::function<void(atomic_file&)> write;
};

/// Writes several files that appear together or not at all: all are written in their order, then what are devices and
/// pipes, then the files get their names. Throws io_error; then no file has changed, but for the rare case that the
/// system refuses to rename a finished file, where the message says which files have been replaced.
void write_files(std::span<const file_to_write> files);

} // namespace taut::io

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/io/file/write_files.ipp>
#endif
