// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>

#include <taut/files.hpp>
#include <taut/impl/files/surface/obj_output.hpp>
#include <taut/paste.hpp>
#include <taut/surface_file.hpp>

namespace taut
{

inline void paste::write(io::atomic_file& out, const io::surface_file& target, const io::surface_file& source) const
{
    const auto write_lines = [&](const char* key, const auto& rows, const auto& append)
    { io::impl::write_items(out, rows.size(), [&](std::string& text, std::size_t i) { append(text, key, rows[i]); }); };
    write_lines("v", points(),
                [](std::string& text, const char* key, const vec3& x) {
                    io::impl::append_line(text, key, {x.x, x.y, x.z});
                });
    const auto append_texcoord = [](std::string& text, const char* key, const vec2& x) {
        io::impl::append_line(text, key, {x.x, x.y});
    };
    write_lines("vt", target.texcoords, append_texcoord);
    write_lines("vt", source.texcoords, append_texcoord);

    const auto append = [](std::string& text, const std::array<idx, 3>& t, const std::array<idx, 3>& texcoords)
    {
        if (texcoords[0] >= 0 && texcoords[1] >= 0 && texcoords[2] >= 0)
            return io::impl::append_face(text, t, texcoords, false);
        text += 'f';
        for (const idx v : t)
        {
            text += ' ';
            io::impl::append_number(text, v + 1);
        }
        text += '\n';
    };
    constexpr std::array<idx, 3> none{-1, -1, -1};
    const auto& region = part().region;
    const auto first_texcoord = static_cast<idx>(target.texcoords.size());
    io::impl::write_items(out, cells().size(),
                          [&](std::string& text, std::size_t f)
                          {
                              auto texcoords = none;
                              if (f < kept_faces().size())
                              {
                                  if (!target.texcoord_cells.empty())
                                      texcoords = target.texcoord_cells[static_cast<std::size_t>(kept_faces()[f])];
                              }
                              else if (f >= static_cast<std::size_t>(first_feature()) && !source.texcoord_cells.empty())
                              {
                                  const std::size_t own = f - static_cast<std::size_t>(first_feature());
                                  if (region.faces[own] < 0) return append(text, cells()[f], none);
                                  const auto of_source = static_cast<std::size_t>(region.faces[own]);
                                  texcoords = source.texcoord_cells[of_source];
                                  for (std::size_t k = 0; k < 3; ++k)
                                  {
                                      const idx v = region.surface.cells()[own][k];
                                      const bool same = region.vertices[static_cast<std::size_t>(v)] ==
                                                        source.surface.cells()[of_source][k];
                                      texcoords[k] = same && texcoords[k] >= 0 ? texcoords[k] + first_texcoord : -1;
                                  }
                              }
                              append(text, cells()[f], texcoords);
                          });
}

inline void paste::write(const std::filesystem::path& path, const io::surface_file& target,
                         const io::surface_file& source) const
{
    io::atomic_file out(path);
    write(out, target, source);
    out.commit();
}

} // namespace taut
