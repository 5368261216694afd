// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include <taut/impl/io/io_error.hpp>
#include <taut/impl/io/surface_file.hpp>

namespace taut::io
{

/// File formats of surfaces. automatic: by the extension, in either case; by the first bytes for standard input and
/// pipes, which have none.
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

/// Reads the triangles of a file without validation, for repair_surface(). Throws io_error.
surface_soup read_surface_soup(const std::filesystem::path& path, surface_format format = surface_format::automatic);

/// Reads a surface without its texture coordinates and notes.
mesh<triangle> read_surface(const std::filesystem::path& path, surface_format format = surface_format::automatic);

} // namespace taut::io

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/io/surface/read_surface.ipp>
#endif
