// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/impl/core/mesh/order.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/impl/files/surface/obj.hpp>
#include <taut/impl/files/surface/obj_output.hpp>
#include <taut/mesh.hpp>
#include <taut/repair.hpp>
#include <taut/surface_file.hpp>

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
    const auto sides = impl::facets(surface);
    const auto found = check(surface, sides);
    const auto same = check(impl::permute(surface, impl::locality_order(surface)));
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
    io::impl::write_with_texcoords(out, file, corners, uv);
    try
    {
        const auto back = io::impl::parse_obj(out.text);
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

/// All that holds for a file that was read as it is: what is left of it after repair is an oriented manifold.
inline void require_repairable(const io::surface_soup& soup)
{
    std::size_t corners = 0;
    for (const idx size : soup.faces.sizes) corners += static_cast<std::size_t>(size);
    require(corners == soup.faces.corners.size(), "faces have all corners");
    for (const auto& cell : soup.texcoord_cells)
        for (const idx t : cell)
            require(t >= -1 && t < static_cast<idx>(soup.texcoords.size()), "texture coordinates in range");
    for (const auto& cell : soup.normal_cells)
        for (const idx n : cell) require(n >= -1 && n < static_cast<idx>(soup.normals.size()), "normals in range");
    for (std::size_t c = 0; c < soup.triangles.size(); ++c)
        for (std::size_t k = 0; k < 3; ++k)
            require(soup.faces.corners[soup.faces.corner(c, k)] == soup.triangles[c][k],
                    "corners of triangles are corners of faces");
    const mesh_requirements any{.connected = false, .open = false, .one_boundary = false, .no_handles = false};
    const auto repaired =
        repair_surface(soup.points, soup.triangles, {.normals = soup.normals, .normal_cells = soup.normal_cells});
    require(check(repaired.surface, any).empty(), "what is repaired is an oriented manifold");
    for (std::size_t c = 0; c < repaired.cell_origins.size(); ++c)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto v = static_cast<std::size_t>(repaired.surface.cells()[c][k]);
            const auto& t = soup.triangles[static_cast<std::size_t>(repaired.cell_origins[c])];
            require(repaired.surface.points()[v] ==
                        soup.points[static_cast<std::size_t>(t[repaired.corner_origin(c, k)])],
                    "corners of repaired triangles are corners of the file");
        }
}

/// All that holds for a file that was read. What is written for it.
inline std::string require_promises(const io::surface_file& file)
{
    require_in_range(file);
    require_examinable(file.surface);
    try
    {
        if (const auto cut = file.cut_seams())
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
