// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include <taut/core/error.hpp>
#include <taut/io/picture/image.hpp>

namespace taut::tools
{

/// A picture that could not be encoded or written; what() names the file and the reason.
class picture_error : public error
{
public:
    using error::error;
};

/// The bytes of a PNG file. Errors: picture_error for an empty image.
std::string encode_png(const io::image& picture);

/// Writes bytes under a temporary name next to `path`, then renames: a reader sees the old file or the new one, never
/// half of it, and a full disk leaves the old one. Errors: picture_error; the temporary file is removed.
void write_whole_file(const std::filesystem::path& path, const std::string& bytes);

/// Writes a picture as PNG, whole or not at all. Errors: picture_error.
void write_png(const std::filesystem::path& path, const io::image& picture);

} // namespace taut::tools
