// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <taut/impl/files/file/text_list.hpp>
#include <taut/types.hpp>

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
