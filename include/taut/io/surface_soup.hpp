// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <taut/io/surface_file.hpp>

namespace taut::io
{

/// What a file of a surface holds, as it is: triangles may name vertices that are not there, or one twice, coordinates
/// may be no numbers, and there may be no triangle. repair_surface() makes a surface of it.
struct surface_soup
{
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> triangles;      ///< of faces; polygons with a vertex that cannot be used as fans
                                                    ///< around its corner
    std::vector<vec2> texcoords;                    ///< as in surface_file
    std::vector<std::array<idx, 3>> texcoord_cells; ///< -1 also where the file names one that is not there
    std::vector<vec3> normals;                      ///< as in the file; empty if it has none
    std::vector<std::array<idx, 3>> normal_cells; ///< one triple a triangle, into normals, -1: none; empty: the normal
                                                  ///< of a corner has the number of its vertex
    std::vector<std::string> notes;               ///< as in surface_file, and the rest, too
    file_faces faces;
    file_vertices vertices;
    obj_text obj;
    std::optional<mesh_error> fault; ///< the first index or coordinate that cannot be used, and its place in the file
};

/// The surface of triangles without such faults. path: named in errors. Throws `fault`, or mesh_error as mesh does.
inline surface_file to_surface_file(surface_soup&& soup, const std::string& path)
{
    if (soup.fault) throw mesh_error(*soup.fault);
    try
    {
        return {mesh<triangle>(std::move(soup.points), std::move(soup.triangles)),
                std::move(soup.texcoords),
                std::move(soup.texcoord_cells),
                std::move(soup.notes),
                std::move(soup.faces),
                std::move(soup.vertices),
                std::move(soup.obj)};
    }
    catch (const mesh_error& e)
    {
        throw mesh_error(e.fault(), e.ids(), path + ": " + e.what());
    }
}

} // namespace taut::io
