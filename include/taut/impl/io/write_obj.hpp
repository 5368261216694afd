// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <taut/impl/io/atomic_file.hpp>
#include <taut/impl/io/cut_seams.hpp>

namespace taut::io
{

/// Writes a surface and a map of it to the plane as OBJ: the vertices in their order with values that read back bit
/// for bit, one vt per vertex, faces v/vt.
/// uv: one per vertex. Throws io_error; parameter_error if uv has another size.
void write_obj(atomic_file& out, const mesh<triangle>& surface, std::span<const vec2> uv);

/// Writes the file that a surface was read from with other texture coordinates. Of OBJ every byte stays, but for vt
/// lines and the numbers of texture coordinates in faces; OFF and PLY become OBJ with their vertices, colours, normals,
/// polygons and comments.
/// uv: one per vertex. Throws io_error; parameter_error if uv has another size.
void write_obj(atomic_file& out, const surface_file& file, std::span<const vec2> uv);

/// The same for a map of the surface cut open, which `cut` was made by file.cut_seams().
/// uv: one per vertex of cut.surface.
void write_obj(atomic_file& out, const surface_file& file, const cut_surface& cut, std::span<const vec2> uv);

/// The same for a file as it is, whose corners have texture coordinates of their own, or none. A face gets them at all
/// corners or at none: a corner of a polygon that has none gets what lies between those before and after it.
/// texcoords: one per corner of file.faces, an index into uv; -1: none. Throws io_error; parameter_error if there are
/// more or fewer, or one names what is not there.
void write_obj(atomic_file& out, const surface_soup& file, std::span<const idx> texcoords, std::span<const vec2> uv);

/// Any of these to a file of its own, which appears complete or not at all.
template <class... Content>
void write_obj(const std::filesystem::path& path, const Content&... content)
{
    atomic_file out(path);
    write_obj(out, content...);
    out.commit();
}

} // namespace taut::io

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/io/surface/write_obj.ipp>
#endif
