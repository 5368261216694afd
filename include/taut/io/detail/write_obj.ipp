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
#include <taut/io/write_obj.hpp>
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

TAUT_INLINE void write_obj(atomic_file& out, const mesh<triangle>& surface, std::span<const vec2> uv)
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

TAUT_INLINE void write_obj(atomic_file& out, const surface_file& file, std::span<const vec2> uv)
{
    detail::require_texcoords(uv, file.surface);
    detail::write_with_texcoords(out, file, file.faces.corners, uv);
}

TAUT_INLINE void write_obj(atomic_file& out, const surface_file& file, const cut_surface& cut, std::span<const vec2> uv)
{
    detail::require_texcoords(uv, cut.surface);
    detail::write_with_texcoords(out, file, cut.corners, uv);
}

} // namespace taut::io
