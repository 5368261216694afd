// SPDX-License-Identifier: MIT
#include "atlas/joined_surfaces.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <taut/impl/files/surface/obj_output.hpp>

namespace taut::tools
{

joined_surfaces join(const std::vector<std::unique_ptr<atlas_source>>& sources)
{
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    std::vector<idx> first_cell{0}, first_vertex{0};
    for (const auto& source : sources)
    {
        const auto& m = source->surface();
        const auto& placed = source->points_in_scene();
        points.insert(points.end(), placed.begin(), placed.end());
        for (auto t : m.cells())
        {
            for (idx& v : t) v += first_vertex.back();
            cells.push_back(t);
        }
        first_cell.push_back(first_cell.back() + m.cell_count());
        first_vertex.push_back(first_vertex.back() + m.vertex_count());
    }
    return {mesh<triangle>(std::move(points), std::move(cells)), std::move(first_cell), std::move(first_vertex)};
}

std::vector<idx> vertices_of_files(const std::vector<std::unique_ptr<atlas_source>>& sources,
                                   const joined_surfaces& joined, std::span<const idx> vertices)
{
    std::vector<idx> result;
    idx before = 0; // in the files
    for (std::size_t i = 0; i < sources.size(); ++i)
    {
        for (const idx v : vertices)
            if (v >= joined.first_vertex[i] && v < joined.first_vertex[i + 1])
                result.push_back(before + sources[i]->vertex_origin(v - joined.first_vertex[i]));
        before += sources[i]->file_vertices;
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

corner_maps::corner_maps(const joined_surfaces& joined, const atlas& made)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    const auto cells = made.corners(); // in the order of the joined surface
    for (std::size_t i = 0; i + 1 < joined.first_cell.size(); ++i)
    {
        std::vector<idx> number(made.uv.size(), -1);
        part own;
        own.uv.reserve(made.uv.size());
        own.cells.reserve(u(joined.first_cell[i + 1] - joined.first_cell[i]));
        for (auto c = u(joined.first_cell[i]); c < u(joined.first_cell[i + 1]); ++c)
        {
            own.cells.push_back(cells[c]);
            for (idx& v : own.cells.back())
            {
                idx& n = number[u(v)];
                if (n < 0)
                {
                    n = static_cast<idx>(own.uv.size());
                    own.uv.push_back(made.uv[u(v)]);
                }
                v = n;
            }
        }
        parts_.push_back(std::move(own));
    }
}

corner_map corner_maps::of(std::size_t file) const
{
    return {parts_[file].uv, parts_[file].cells};
}

void write_joined(io::atomic_file& out, std::span<const std::string> names,
                  const std::vector<std::unique_ptr<atlas_source>>& sources, const joined_surfaces& joined,
                  const corner_maps& maps)
{
    idx first_texcoord = 0;
    for (std::size_t i = 0; i < names.size(); ++i)
    {
        out.write("o " + std::filesystem::path(names[i]).stem().string() + '\n');
        const auto& points = sources[i]->surface().points();
        io::impl::write_items(out, points.size(),
                              [&](std::string& text, std::size_t v) {
                                  io::impl::append_line(text, "v", {points[v].x, points[v].y, points[v].z});
                              });
        const corner_map map = maps.of(i);
        io::impl::write_texcoords(out, map.uv);
        const auto first_cell = static_cast<std::size_t>(joined.first_cell[i]);
        io::impl::write_items(out, map.cells.size(),
                              [&](std::string& text, std::size_t c)
                              {
                                  auto texcoords = map.cells[c];
                                  for (idx& t : texcoords) t += first_texcoord;
                                  io::impl::append_face(text, joined.surface.cells()[first_cell + c], texcoords, false);
                              });
        first_texcoord += static_cast<idx>(map.uv.size());
    }
}

} // namespace taut::tools
