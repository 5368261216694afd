// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <taut/mesh/mesh.hpp>

namespace taut::io
{

/// A vertex whose corners carry no texture coordinate, or several: a flat map of the surface cannot be read off.
class texcoord_error : public error
{
public:
    texcoord_error(index vertex, const std::string& what) : error(what), vertex_(vertex) {}
    index vertex() const noexcept { return vertex_; }

private:
    index vertex_;
};

/// What a file of a surface holds. Vertices and faces are in the order of the file, unreferenced vertices included.
struct surface_file
{
    mesh<triangle> surface;
    std::vector<vec2> texcoords; ///< as in the file; empty if it has none
    std::vector<std::array<index, 3>>
        texcoord_cells;                   ///< one triple a triangle, into texcoords; -1: that corner has none
    std::vector<std::string> extras = {}; ///< OBJ: what stands on v lines behind the position (colours); else empty
    std::vector<std::string> notes = {};  ///< what was changed in reading, in sentences

    /// The texture coordinate of each vertex; 0 for a vertex without a triangle.
    /// Throws texcoord_error if a vertex has none, or lies on a seam: corners with different ones.
    std::vector<vec2> vertex_texcoords() const
    {
        const auto n = static_cast<std::size_t>(surface.vertex_count());
        std::vector<vec2> result(n, vec2(0.0));
        std::vector<char> known(n, 0);
        for (std::size_t c = 0; c < surface.cells().size(); ++c)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const index vertex = surface.cells()[c][k];
                const index t = texcoord_cells.empty() ? -1 : texcoord_cells[c][k];
                if (t < 0)
                    throw texcoord_error(vertex, "vertex " + std::to_string(vertex) + " has no texture coordinate");
                const auto v = static_cast<std::size_t>(vertex);
                const vec2 x = texcoords[static_cast<std::size_t>(t)];
                if (known[v] && result[v] != x)
                    throw texcoord_error(vertex, "vertex " + std::to_string(vertex) +
                                                     " has several texture coordinates: it lies on a seam");
                known[v] = 1;
                result[v] = x;
            }
        return result;
    }
};

} // namespace taut::io
