// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <taut/io/cut_seams.hpp>
#include <taut/io/detail/obj_output.hpp>
#include <taut/io/obj.hpp>
#include <taut/mesh/boundary.hpp>
#include <taut/mesh/order.hpp>
#include <taut/mesh/validate.hpp>

#include "require.hpp"

namespace taut::fuzz
{

/// Every index of a surface names something.
inline void require_in_range(const io::surface_file& file)
{
    const auto& cells = file.surface.cells();
    const auto& faces = file.faces;
    require(file.texcoord_cells.empty() || file.texcoord_cells.size() == cells.size(),
            "texture coordinates a triangle");
    for (const auto& cell : file.texcoord_cells)
        for (const idx t : cell)
            require(t >= -1 && t < static_cast<idx>(file.texcoords.size()), "texture coordinates in range");
    std::size_t corners = 0;
    for (const idx size : faces.sizes) corners += static_cast<std::size_t>(size);
    require(corners == faces.corners.size(), "faces have all corners");
    require(faces.triangles.empty() || faces.triangles.size() == cells.size(), "corners of each triangle");
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (std::size_t k = 0; k < 3; ++k)
        {
            require(cells[c][k] >= 0 && cells[c][k] < file.surface.vertex_count(), "vertices in range");
            require(faces.corner(c, k) < corners && faces.corners[faces.corner(c, k)] == cells[c][k],
                    "corners of triangles are corners of faces");
        }
}

/// What check(), the order and the boundary promise of any surface.
inline void require_examinable(const mesh<triangle>& surface)
{
    const auto sides = facets(surface);
    const auto found = check(surface, sides);
    const auto same = check(permute(surface, locality_order(surface)));
    require(found.size() == same.size(), "another order has the same faults");
    if (sides.oriented()) boundary_loops(surface, sides);
}

struct text_output
{
    std::string text;
    void write(std::string_view part) { text += part; }
};

/// What is written reads back as the same surface, with the texture coordinates that were given.
inline std::string require_round_trip(const io::surface_file& file, const std::vector<mesh<triangle>::cell>& cells,
                                      std::span<const idx> corners, std::size_t vertices)
{
    std::vector<vec2> uv;
    for (std::size_t v = 0; v < vertices; ++v) uv.emplace_back(static_cast<double>(v), 0.1);
    text_output out;
    io::detail::write_with_texcoords(out, file, corners, uv);
    try
    {
        const auto back = io::parse_obj(out.text);
        require(back.surface.points() == file.surface.points(), "the same vertices");
        require(back.surface.cells() == file.surface.cells(), "the same triangles");
        require(back.texcoords == uv && back.texcoord_cells == cells, "the texture coordinates that were written");
    }
    catch (const error& e)
    {
        std::fprintf(stderr, "%s\n%s\n", e.what(), out.text.c_str());
        require(false, "what is written can be read");
    }
    return out.text;
}

/// All that holds for a file that was read. What is written for it.
inline std::string require_promises(const io::surface_file& file)
{
    require_in_range(file);
    require_examinable(file.surface);
    try
    {
        if (const auto cut = io::cut_seams(file))
        {
            require(cut->seam_vertices > 0 && cut->origins.size() == cut->uv.size(), "a seam has sheets");
            for (std::size_t c = 0; c < cut->surface.cells().size(); ++c)
                for (std::size_t k = 0; k < 3; ++k)
                    require(cut->corners[file.faces.corner(c, k)] == cut->surface.cells()[c][k], "faces stay whole");
            require_examinable(cut->surface);
            require_round_trip(file, cut->surface.cells(), cut->corners, cut->uv.size());
        }
    }
    catch (const io::texcoord_error&)
    {
    }
    return require_round_trip(file, file.surface.cells(), file.faces.corners, file.surface.points().size());
}

} // namespace taut::fuzz
