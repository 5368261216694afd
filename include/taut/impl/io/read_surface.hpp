// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include <taut/impl/io/io_error.hpp>
#include <taut/impl/io/surface_file.hpp>

namespace taut::io
{

/// The kinds of files that surfaces are read from. automatic: as the extension says, in either case; what has none
/// because it is standard input or a pipe, as it begins.
enum class surface_format
{
    automatic,
    obj,
    off,
    ply,
    stl
};

/// Reads a surface with its texture coordinates and notes.
/// Throws io_error (unreadable, unknown or malformed, with line or byte), mesh_error (empty, NaN, ...).
surface_file read_surface_file(const std::filesystem::path& path, surface_format format = surface_format::automatic);

/// Reads a file as it is, for repair_surface(). Throws io_error.
surface_soup read_surface_soup(const std::filesystem::path& path, surface_format format = surface_format::automatic);

/// The surface alone.
mesh<triangle> read_surface(const std::filesystem::path& path, surface_format format = surface_format::automatic);

} // namespace taut::io

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/io/detail/read_surface.ipp>
#endif
