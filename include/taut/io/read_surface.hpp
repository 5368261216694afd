// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include <taut/io/obj.hpp>
#include <taut/io/off.hpp>
#include <taut/io/ply.hpp>
#include <taut/io/read_file.hpp>

namespace taut::io
{

/// Reads a surface from a file whose name ends in .obj, .off or .ply, in either case, with its texture coordinates
/// and notes. Throws io_error (unreadable, unknown or malformed, with line or byte), mesh_error (empty, NaN, ...).
inline surface_file read_surface_file(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    const std::string name = path.string();
    if (extension == ".obj") return parse_obj(read_file(path), name);
    if (extension == ".off") return parse_off(read_file(path), name);
    if (extension == ".ply") return parse_ply(read_file(path), name);
    throw io_error(name, "unknown kind of file; surfaces are read from .obj, .off and .ply");
}

/// The surface alone.
inline mesh<triangle> read_surface(const std::filesystem::path& path)
{
    return read_surface_file(path).surface;
}

} // namespace taut::io
