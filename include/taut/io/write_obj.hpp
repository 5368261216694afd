// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include <taut/io/atomic_file.hpp>
#include <taut/io/cut_seams.hpp>
#include <taut/io/detail/obj_output.hpp>
#include <taut/io/surface_file.hpp>
#include <taut/mesh/mesh.hpp>

namespace taut::io
{
namespace detail
{

inline void require_texcoords(std::span<const vec2> uv, const mesh<triangle>& surface)
{
    if (uv.size() != surface.points().size())
        throw parameter_error("uv", std::to_string(uv.size()) + " texture coordinates for " +
                                        std::to_string(surface.points().size()) + " vertices; give one a vertex");
}

} // namespace detail

/// Writes a surface and a map of it to the plane as OBJ: the vertices in their order with values that read back bit
/// for bit, one vt a vertex, faces v/vt.
/// uv: one a vertex. Throws io_error; parameter_error if uv has another size.
inline void write_obj(atomic_file& out, const mesh<triangle>& surface, std::span<const vec2> uv)
{
    detail::require_texcoords(uv, surface);
    detail::write_items(out, uv.size(),
                        [&](std::string& text, std::size_t v)
                        {
                            const vec3& p = surface.points()[v];
                            detail::append_line(text, "v", {p.x, p.y, p.z});
                        });
    detail::write_texcoords(out, uv);
    detail::write_items(out, surface.cells().size(),
                        [&](std::string& text, std::size_t c)
                        { detail::append_face(text, surface.cells()[c], surface.cells()[c], false); });
}

/// Writes the file that a surface was read from with other texture coordinates. Of OBJ every byte stays, but for vt
/// lines and the numbers of texture coordinates in faces; OFF and PLY become OBJ with their vertices, colours, normals,
/// polygons and comments.
/// uv: one a vertex. Throws io_error; parameter_error if uv has another size.
inline void write_obj(atomic_file& out, const surface_file& file, std::span<const vec2> uv)
{
    detail::require_texcoords(uv, file.surface);
    detail::write_with_texcoords(out, file, file.faces.corners, uv);
}

/// The same for a map of the surface cut open, which `cut` was made from `file` by cut_seams().
/// uv: one a vertex of cut.surface.
inline void write_obj(atomic_file& out, const surface_file& file, const cut_surface& cut, std::span<const vec2> uv)
{
    detail::require_texcoords(uv, cut.surface);
    detail::write_with_texcoords(out, file, cut.corners, uv);
}

/// Any of these to a file of its own, which appears complete or not at all.
template <class... Content>
void write_obj(const std::filesystem::path& path, const Content&... content)
{
    atomic_file out(path);
    write_obj(out, content...);
    out.commit();
}

} // namespace taut::io
