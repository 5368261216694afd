// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/io/surface_file.hpp>

namespace taut::io
{

/// A surface cut open along the seams of its texture coordinates, so that each vertex has one: the vertices of the file
/// in their order, then a further one for each further sheet of a vertex on a seam. Triangles keep their order.
struct cut_surface
{
    mesh<triangle> surface;
    std::vector<vec2> uv;          ///< of the file, one a vertex; 0 for a vertex without a triangle
    std::vector<index> origins;    ///< the vertex of the file, one a vertex
    std::vector<index> corners;    ///< the vertex of each corner of file_faces
    std::size_t seam_vertices = 0; ///< vertices of the file that lie on a seam
};

namespace detail
{

/// Hands out the sheets of vertices: one for each value that its corners have; many programs write one vt a corner.
class sheets
{
public:
    explicit sheets(std::size_t vertices) : uv_(vertices, vec2(0.0)), used_(vertices, 0), origins_(vertices)
    {
        for (std::size_t v = 0; v < vertices; ++v) origins_[v] = static_cast<index>(v);
    }

    /// The sheet of a vertex where its texture coordinate is x.
    index at(index vertex, vec2 x)
    {
        const auto v = static_cast<std::size_t>(vertex);
        if (!used_[v])
        {
            used_[v] = 1;
            uv_[v] = x;
        }
        if (uv_[v] == x) return vertex;
        x += 0.0; // one zero
        const auto [found, added] = further_.try_emplace({vertex, x.x, x.y}, static_cast<index>(uv_.size()));
        if (added)
        {
            seam_vertices_ += used_[v] == 1 ? 1 : 0;
            used_[v] = 2;
            uv_.push_back(x);
            origins_.push_back(vertex);
        }
        return found->second;
    }

    std::vector<vec2>& uv() { return uv_; }
    std::vector<index>& origins() { return origins_; }
    std::size_t seam_vertices() const { return seam_vertices_; }

private:
    std::vector<vec2> uv_;
    std::vector<char> used_; // 1: has a sheet, 2: has several
    std::vector<index> origins_;
    std::map<std::tuple<index, double, double>, index> further_;
    std::size_t seam_vertices_ = 0;
};

} // namespace detail

/// Cuts a surface open wherever neighbouring corners disagree. Throws texcoord_error if a corner has no texture
/// coordinate.
inline cut_surface cut_seams(const surface_file& file)
{
    detail::sheets sheets(file.surface.points().size());
    auto cells = file.surface.cells();
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (std::size_t k = 0; k < 3; ++k) cells[c][k] = sheets.at(cells[c][k], file.texcoord(c, k));
    // Corners of faces are corners of triangles: no sheet is added.
    auto corners = file.faces.corners;
    for (std::size_t i = 0; i < corners.size(); ++i)
        corners[i] = sheets.at(corners[i], file.texcoords[static_cast<std::size_t>(file.faces.texcoords[i])]);
    auto points = file.surface.points();
    for (std::size_t s = points.size(); s < sheets.origins().size(); ++s)
        points.push_back(vec3(points[static_cast<std::size_t>(sheets.origins()[s])]));
    return {mesh<triangle>(std::move(points), std::move(cells)), std::move(sheets.uv()), std::move(sheets.origins()),
            std::move(corners), sheets.seam_vertices()};
}

} // namespace taut::io
