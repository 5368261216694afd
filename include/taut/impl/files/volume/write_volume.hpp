// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <taut/files.hpp>
#include <taut/impl/core/mesh/refine_elements.hpp>
#include <taut/volume_file.hpp>

namespace taut::io::impl
{

/// The bytes of the file with other coordinates. A coordinate that has not changed, bit for bit, keeps its bytes;
/// others are the shortest decimal that reads back the same double, or binary as the file has it.
/// points: one per point of the file; z = that of the file where it has two coordinates.
/// Throws parameter_error: another number of points, a coordinate that is not finite (also after rounding), a z that
/// the file has no place for.
std::string with_points(const volume_file& file, std::span<const vec3> points);

/// The files that make up a mesh with other coordinates, for write_files: one, for TetGen PATH.node and its companions
/// PATH.ele, PATH.face. Both arguments must outlive the result.
/// Throws parameter_error as with_points(); io_error where an output is an input, or the extension another format's,
/// and as require_own_tetgen_files().
std::vector<file_to_write> volume_outputs(const std::filesystem::path& path, const volume_file& file,
                                          std::span<const vec3> points);

/// As require_own_parts() of TetGen's files; throws io_error also where the output would have a .face that is not
/// written with it.
void require_own_tetgen_files(const std::filesystem::path& output, std::span<const std::filesystem::path> written);

/// The file with cells subdivided, as its own format has it, written anew as text: `bytes` and all else as a reader of
/// that finds it, `path` as it was, `rest` subdivided, too. Points come first as they were, and parts of a cell follow
/// each other; they have its labels, and a new point those that all corners of what it splits have, or else 0.
/// MEDIT (references, corners, required vertices), gmsh (as 2.2, nodes numbered from 1; names of physical groups, of
/// several of a cell the first), VTK and VTU (integer arrays of one component), problems. What else was in the file is
/// not in the result, which its notes say.
/// Throws io_error for other formats, and for cells other than vertices, lines, triangles and tetrahedra;
/// parameter_error for a subdivision of another number of points.
volume_file subdivided(const volume_file& file, const taut::impl::subdivision& how);

} // namespace taut::io::impl
