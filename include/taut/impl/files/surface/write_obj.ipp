// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <taut/impl/files/surface/complete_texcoords.hpp>
#include <taut/impl/files/surface/obj_output.hpp>
#include <taut/impl/files/surface/obj_statements.hpp>
#include <taut/mesh.hpp>
#include <taut/surface_file.hpp>
#include <vector>

namespace taut::io::impl
{

inline void require_texcoords(std::span<const vec2> uv, const mesh<triangle>& surface)
{
    if (uv.size() != surface.points().size())
        throw parameter_error("uv", std::to_string(uv.size()) + " texture coordinates for " +
                                        std::to_string(surface.points().size()) + " vertices; give one per vertex");
}

/// The text of an OBJ file with other coordinates in its v statements; what follows them there stays.
template <class Out>
void write_with_points(Out& out, std::string_view bytes, std::span<const vec3> points)
{
    scanner in(bytes, {});
    std::string text;
    const char* copied = bytes.data();
    std::size_t v = 0;
    for_each_statement(in,
                       [&](std::string_view key, const char*)
                       {
                           if (key != "v" || v >= points.size()) return;
                           text.append(copied, in.position());
                           const vec3& p = points[v++];
                           append_line(text, "", {p.x, p.y, p.z}, "");
                           for (int k = 0; k < 3; ++k) in.word();
                           copied = in.position();
                       });
    text.append(copied, bytes.data() + bytes.size());
    out.write(text);
}

} // namespace taut::io::impl

namespace taut::io
{

void write_obj(atomic_file& out, const mesh<triangle>& surface, std::span<const vec2> uv)
{
    impl::require_texcoords(uv, surface);
    impl::write_items(out, uv.size(),
                      [&](std::string& text, std::size_t v)
                      {
                          const vec3& p = surface.points()[v];
                          impl::append_line(text, "v", {p.x, p.y, p.z});
                      });
    impl::write_texcoords(out, uv);
    impl::write_items(out, surface.cells().size(),
                      [&](std::string& text, std::size_t c)
                      { impl::append_face(text, surface.cells()[c], surface.cells()[c], false); });
}

void write_obj(atomic_file& out, const surface_file& file, std::span<const vec2> uv)
{
    impl::require_texcoords(uv, file.surface);
    impl::write_with_texcoords(out, file, file.faces.corners, uv);
}

void write_obj(atomic_file& out, const surface_file& file, const cut_surface& cut, std::span<const vec2> uv)
{
    impl::require_texcoords(uv, cut.surface);
    impl::write_with_texcoords(out, file, cut.corners, uv);
}

void write_obj(atomic_file& out, const surface_soup& file, std::span<const idx> texcoords, std::span<const vec2> uv)
{
    if (texcoords.size() != file.faces.corners.size())
        throw parameter_error("texcoords", std::to_string(texcoords.size()) + " for " +
                                               std::to_string(file.faces.corners.size()) +
                                               " corners of faces; give one per corner");
    for (const idx t : texcoords)
        if (t < -1 || t >= static_cast<idx>(uv.size()))
            throw parameter_error("texcoords", std::to_string(t) + " of " + std::to_string(uv.size()) +
                                                   "; numbers start at 0, -1 is none");
    std::vector<idx> complete(texcoords.begin(), texcoords.end());
    std::vector<vec2> coords(uv.begin(), uv.end());
    impl::complete_texcoords(file.faces, file.points, complete, coords);
    impl::write_with_texcoords(out, file, complete, coords);
}

void surface_file::write(atomic_file& out, std::span<const vec3> points) const
{
    if (points.size() != surface.points().size())
        throw parameter_error("points", std::to_string(points.size()) + " positions for " +
                                            std::to_string(surface.points().size()) + " vertices; give one per vertex");
    if (!obj.bytes.empty()) return impl::write_with_points(out, obj.bytes, points);
    impl::write_items(out, points.size(),
                      [&](std::string& text, std::size_t v)
                      {
                          const vec3& p = points[v];
                          if (vertices.colours.empty()) return impl::append_line(text, "v", {p.x, p.y, p.z});
                          const vec3& c = vertices.colours[v];
                          impl::append_line(text, "v", {p.x, p.y, p.z, c.x, c.y, c.z});
                      });
    std::vector<std::size_t> first{0};
    for (const idx size : faces.sizes) first.push_back(first.back() + static_cast<std::size_t>(size));
    impl::write_items(out, faces.sizes.size(),
                      [&](std::string& text, std::size_t f)
                      {
                          text += 'f';
                          for (std::size_t k = first[f]; k < first[f + 1]; ++k)
                          {
                              text += ' ';
                              impl::append_number(text, faces.corners[k] + 1);
                          }
                          text += '\n';
                      });
}

void surface_file::write(const std::filesystem::path& path, std::span<const vec3> points) const
{
    atomic_file out(path);
    write(out, points);
    out.commit();
}

} // namespace taut::io
