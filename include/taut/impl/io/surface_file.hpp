// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/io/file/text_list.hpp>
#include <taut/impl/mesh/describe.hpp>
#include <taut/impl/mesh/mesh.hpp>
#include <taut/impl/mesh/unused_vertices.hpp>

namespace taut::io
{

/// Error of a vertex whose corners carry no texture coordinate, or several: the file defines no map of the surface.
class texcoord_error : public error
{
public:
    texcoord_error(idx vertex, const std::string& what) : error(what), vertex_(vertex) {}
    idx vertex() const noexcept { return vertex_; }

private:
    idx vertex_;
};

} // namespace taut::io

namespace taut::io::impl
{

/// Faces as a file has them, before polygons are split into triangles.
struct file_faces
{
    std::vector<idx> sizes;                    ///< corners of each
    std::vector<idx> corners;                  ///< the vertex of each corner, one face after the other
    std::vector<std::array<idx, 3>> triangles; ///< the corners of each triangle; empty if all faces are triangles

    /// The corner that corner k of triangle c is.
    std::size_t corner(std::size_t c, std::size_t k) const
    {
        return triangles.empty() ? 3 * c + k : static_cast<std::size_t>(triangles[c][k]);
    }

    /// The face that each triangle is of; empty if all faces are triangles.
    std::vector<idx> of_triangles() const
    {
        std::vector<idx> face, result;
        if (triangles.empty()) return result;
        for (std::size_t f = 0; f < sizes.size(); ++f)
            face.insert(face.end(), static_cast<std::size_t>(sizes[f]), static_cast<idx>(f));
        for (const auto& t : triangles) result.push_back(face[static_cast<std::size_t>(t[0])]);
        return result;
    }
};

/// Text of an OBJ file, with an index of its statements for write_obj.
struct obj_text
{
    /// Statements that can be read by themselves.
    struct piece
    {
        std::size_t begin;        ///< the first byte
        std::size_t first_corner; ///< number of corners of faces before
    };

    std::string bytes;         ///< all of the file
    std::size_t body = 0;      ///< start of the first vt or f statement
    std::vector<piece> pieces; ///< in their order
};

/// Vertex attributes of OFF and PLY files that OBJ can hold.
struct file_vertices
{
    text_list positions;       ///< coordinates as they are written; none of a binary file
    std::vector<vec3> colours; ///< red, green, blue from 0 to 1; empty if the file has none
    std::vector<vec3> normals; ///< empty if the file has none
    text_list comments;        ///< comments of the file, without the sign they start with
};

} // namespace taut::io::impl

namespace taut::io
{

class atomic_file;
struct cut_surface;

/// Content of a surface file. Vertices and faces are in the order of the file, unreferenced vertices included.
struct surface_file
{
    mesh<triangle> surface;
    std::vector<vec2> texcoords;                    ///< as in the file; empty if it has none
    std::vector<std::array<idx, 3>> texcoord_cells; ///< one triple per triangle, into texcoords; -1: none
    std::vector<std::string> notes = {};            ///< changes in reading, in sentences
    impl::file_faces faces = {};                    ///< faces that the triangles were made from
    impl::file_vertices vertices = {};              ///< OFF and PLY
    impl::obj_text obj = {};                        ///< OBJ; else empty
    std::string texcoord_fault = {}; ///< fault of the texture coordinates of the file, which then are none
                                     ///< here: one is no finite number, or is named and not there; place and fault

    /// The texture coordinate of corner k of triangle c.
    /// Throws texcoord_error if it has none, or one that is not there.
    vec2 texcoord(std::size_t c, std::size_t k) const
    {
        const idx t = texcoord_cells.empty() ? -1 : texcoord_cells[c][k];
        if (t >= 0 && static_cast<std::size_t>(t) < texcoords.size()) return texcoords[static_cast<std::size_t>(t)];
        const idx v = surface.cells()[c][k];
        throw texcoord_error(
            v, "triangle " + std::to_string(c) + " has " +
                   (t < 0 ? "no texture coordinate"
                          : "texture coordinate " + std::to_string(t) + " of " + std::to_string(texcoords.size())) +
                   " at vertex " + std::to_string(v));
    }

    /// The texture coordinate of each vertex; 0 for a vertex without a triangle.
    /// Throws texcoord_error if a corner has none, or if a vertex lies on a seam: corners with different ones.
    std::vector<vec2> vertex_texcoords() const
    {
        const auto n = static_cast<std::size_t>(surface.vertex_count());
        std::vector<vec2> result(n, vec2(0.0));
        std::vector<char> known(n, 0);
        for (std::size_t c = 0; c < surface.cells().size(); ++c)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const idx vertex = surface.cells()[c][k];
                const auto v = static_cast<std::size_t>(vertex);
                const vec2 x = texcoord(c, k);
                if (known[v] && result[v] != x)
                    throw texcoord_error(vertex, "vertex " + std::to_string(vertex) +
                                                     " has several texture coordinates: it lies on a seam");
                known[v] = 1;
                result[v] = x;
            }
        return result;
    }

    /// Writes the file with new positions of its vertices, which read back bit for bit. Of OBJ every byte stays but the
    /// coordinates of v lines, also the normals, which are those at rest; OFF and PLY become OBJ with their vertices,
    /// colours and polygons.
    /// points: one per vertex. Throws io_error; parameter_error if there are more or fewer.
    void write(atomic_file& out, std::span<const vec3> points) const;
    void write(const std::filesystem::path& path, std::span<const vec3> points) const;

    /// Cuts the surface open along the edges where the texture coordinates of neighbours disagree in value; many
    /// programs write one vt per corner. Nothing if every vertex has one texture coordinate.
    /// Throws texcoord_error if a corner has none.
    std::optional<cut_surface> cut_seams() const;
};

/// Content of a surface file without validation: triangles may name vertices that do not exist, or one twice,
/// coordinates may be non-finite, and there may be no triangle. repair_surface() makes a surface of it.
struct surface_soup
{
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> triangles;      ///< of faces; polygons with a vertex that cannot be used as fans
                                                    ///< around its corner
    std::vector<vec2> texcoords;                    ///< as in surface_file
    std::vector<std::array<idx, 3>> texcoord_cells; ///< as in surface_file
    std::vector<vec3> normals;                      ///< as in the file; empty if it has none
    std::vector<std::array<idx, 3>> normal_cells;   ///< one triple per triangle, into normals, -1: none; empty: the
                                                    ///< normal of a corner has the number of its vertex
    std::vector<std::string> notes;                 ///< as in surface_file, and the rest, too
    impl::file_faces faces;
    impl::file_vertices vertices;
    impl::obj_text obj;
    std::optional<mesh_error> fault; ///< the first index, coordinate or face that cannot be used, and its place
    std::string texcoord_fault;      ///< as in surface_file
};

} // namespace taut::io

namespace taut::io::impl
{

/// Notes vertices without a triangle, and moves those with non-finite coordinates to the position of another vertex.
inline void ignore_unused_vertices(surface_soup& soup)
{
    auto unused = taut::impl::unused_vertices(soup.points.size(), soup.triangles);
    if (unused.empty() || soup.triangles.empty()) return;
    soup.notes.push_back(taut::impl::describe_unused(unused));
    std::erase_if(unused,
                  [&](idx v)
                  {
                      const vec3& p = soup.points[static_cast<std::size_t>(v)];
                      return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
                  });
    const idx first = soup.triangles[0][0];
    if (first < 0 || static_cast<std::size_t>(first) >= soup.points.size()) return;
    taut::impl::set_aside(std::span<const idx>(unused), soup.triangles, soup.points);
}

/// Makes the surface of valid triangles. path: named in errors. Throws `fault`, or mesh_error as mesh does.
inline surface_file to_surface_file(surface_soup&& soup, const std::string& path)
{
    if (soup.fault) throw mesh_error(*soup.fault);
    ignore_unused_vertices(soup);
    try
    {
        return {mesh<triangle>(std::move(soup.points), std::move(soup.triangles)),
                std::move(soup.texcoords),
                std::move(soup.texcoord_cells),
                std::move(soup.notes),
                std::move(soup.faces),
                std::move(soup.vertices),
                std::move(soup.obj),
                std::move(soup.texcoord_fault)};
    }
    catch (const mesh_error& e)
    {
        throw mesh_error(e.fault(), e.ids(), path + ": " + e.what());
    }
}

} // namespace taut::io::impl
