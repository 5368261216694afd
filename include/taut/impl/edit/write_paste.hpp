// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include <taut/impl/edit/paste.hpp>
#include <taut/impl/io/atomic_file.hpp>
#include <taut/impl/io/surface/obj_output.hpp>
#include <taut/impl/io/surface_file.hpp>

namespace taut::io
{

/// Writes the result of a paste as OBJ, with values that read back bit for bit. Triangles of the target keep its
/// texture coordinates and those of the feature that of its source, if these have any; vt of the target come first, in
/// their order. Triangles of the gap, and those that were split, have none.
/// target, source: the files that both were read from. Throws io_error.
inline void write_paste(atomic_file& out, const paste& p, const surface_file& target, const surface_file& source)
{
    const auto write_lines = [&](const char* key, const auto& rows, const auto& append)
    { impl::write_items(out, rows.size(), [&](std::string& text, std::size_t i) { append(text, key, rows[i]); }); };
    write_lines("v", p.points(),
                [](std::string& text, const char* key, const vec3& x) {
                    impl::append_line(text, key, {x.x, x.y, x.z});
                });
    const auto append_texcoord = [](std::string& text, const char* key, const vec2& x) {
        impl::append_line(text, key, {x.x, x.y});
    };
    write_lines("vt", target.texcoords, append_texcoord);
    write_lines("vt", source.texcoords, append_texcoord);

    const auto append = [](std::string& text, const std::array<idx, 3>& t, const std::array<idx, 3>& texcoords)
    {
        if (texcoords[0] >= 0 && texcoords[1] >= 0 && texcoords[2] >= 0)
            return impl::append_face(text, t, texcoords, false);
        text += 'f';
        for (const idx v : t)
        {
            text += ' ';
            impl::append_number(text, v + 1);
        }
        text += '\n';
    };
    constexpr std::array<idx, 3> none{-1, -1, -1};
    const auto& part = p.part().region;
    const auto first_texcoord = static_cast<idx>(target.texcoords.size());
    impl::write_items(out, p.cells().size(),
                      [&](std::string& text, std::size_t f)
                      {
                          auto texcoords = none;
                          if (f < p.kept_faces().size())
                          {
                              if (!target.texcoord_cells.empty())
                                  texcoords = target.texcoord_cells[static_cast<std::size_t>(p.kept_faces()[f])];
                          }
                          else if (f >= static_cast<std::size_t>(p.first_feature()) && !source.texcoord_cells.empty())
                          {
                              const std::size_t own = f - static_cast<std::size_t>(p.first_feature());
                              if (part.faces[own] < 0) return append(text, p.cells()[f], none);
                              const auto of_source = static_cast<std::size_t>(part.faces[own]);
                              texcoords = source.texcoord_cells[of_source];
                              for (std::size_t k = 0; k < 3; ++k)
                              {
                                  const idx v = part.surface.cells()[own][k];
                                  const bool same = part.vertices[static_cast<std::size_t>(v)] ==
                                                    source.surface.cells()[of_source][k];
                                  texcoords[k] = same && texcoords[k] >= 0 ? texcoords[k] + first_texcoord : -1;
                              }
                          }
                          append(text, p.cells()[f], texcoords);
                      });
}

} // namespace taut::io
