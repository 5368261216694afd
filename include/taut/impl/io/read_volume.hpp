// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include <taut/impl/io/io_error.hpp>
#include <taut/impl/io/volume_file.hpp>

namespace taut::io
{

/// Reads a volume mesh, or a planar mesh, with its groups.
/// Throws io_error with line or byte: unreadable, unknown, malformed, or a kind of mesh whose coordinates cannot be
/// replaced in the file (higher order, polyhedra, partitions, several pieces).
/// zone: number of the zone in a SU2 file of several, as IZONE= has it, from 1; 0: the file has one
volume_file read_volume_file(const std::filesystem::path& path, volume_format format = volume_format::automatic,
                             int zone = 0);

/// Reads the tetrahedra of a volume mesh. Throws mesh_error as volume_file::tetrahedra().
mesh<tetrahedron> read_volume(const std::filesystem::path& path, volume_format format = volume_format::automatic);

} // namespace taut::io

namespace taut::io::impl
{

/// The same from the bytes of a file. name: in errors. Of any format but TetGen.
volume_file parse_volume(std::string bytes, volume_format format, const std::string& name = "volume data",
                         int zone = 0);

/// The same from the text of a .node file, of its .ele file and, unless that is empty, of its .face file.
volume_file parse_tetgen(std::string nodes, std::string elements, std::string faces = {},
                         const std::string& name = "volume data");

} // namespace taut::io::impl

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/io/volume/read_volume.ipp>
#endif
