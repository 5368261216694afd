// SPDX-License-Identifier: MIT
#pragma once

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

#include <taut/impl/io/read_file.hpp>
#include <taut/impl/io/surface/surface_formats.hpp>
#include <taut/impl/io/volume/formats.hpp>

namespace taut::io::impl
{

/// Throws io_error for a name that is of none of the kinds that a reader takes: the file is not there, is a folder, is
/// of another kind, or of one that nothing reads. wanted: "surfaces are read from .obj, ..."
[[noreturn]] inline void refuse_kind(const std::filesystem::path& path, const std::string& wanted)
{
    std::error_code unknown;
    if (!std::filesystem::exists(path, unknown) && !unknown)
        throw io_error(path.string(), std::generic_category().message(ENOENT));
    if (std::filesystem::is_directory(path, unknown)) throw io_error(path.string(), a_folder);
    const char* const kind = format_of_name(path) != surface_format::automatic ? "a surface in space"
                             : volume_format_of_name(path) != volume_format::automatic
                                 ? "a volume, or a mesh of the plane"
                                 : "an unknown kind of file";
    throw io_error(path.string(), std::string(kind) + "; " + wanted + ", from other names if the format is given");
}

} // namespace taut::io::impl
