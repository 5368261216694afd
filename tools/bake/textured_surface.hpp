// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <taut/bake.hpp>
#include <taut/gltf.hpp>
#include <taut/surface_file.hpp>
#include <taut/types.hpp>

namespace taut::tools
{

/// Texture coordinates of the corners of triangles.
using corner_uv = std::vector<std::array<vec2, 3>>;

/// Whether all corners of a triangle have finite texture coordinates.
bool has_place(const std::array<vec2, 3>& uv);

/// Colours of vertices.
struct vertex_colours
{
    idx channels = 0;          ///< 3, or 4 with alpha
    std::vector<float> values; ///< per corner of triangles
    bool linear = false;       ///< as in glTF; else encoded as sRGB
};

/// Triangles of a file with what is needed to bake: all as the file has it, per corner.
struct textured_surface
{
    std::string path;
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> triangles;
    corner_uv uv;                             ///< v upwards; not a number where there is none
    std::vector<std::array<vec3, 3>> normals; ///< unit vectors; those of the file, else smooth ones, flat ones in glTF
    bool has_normals = false;                 ///< whether the file says them
    std::vector<corner_tangents> tangents;    ///< those of the file; not numbers where it has none
    std::optional<io::gltf_model> model;      ///< of glTF
    std::vector<std::string> notes;
};

/// Throws io_error, mesh_error.
textured_surface read_textured_surface(const std::string& path, io::surface_format format, int texcoord_set);

/// Leaves out triangles without an area: they have no texels. Those that a map of glTF leaves out have all corners in
/// one place.
corner_uv with_area(corner_uv uv);

/// The colours of the vertices of a file: of PLY, OFF, or COLOR_0 of glTF. Throws unsuitable_input where it has none.
vertex_colours read_vertex_colours(const textured_surface& surface, io::surface_format format);

/// Throws unsuitable_input unless both have the same triangles in the same order, up to rounding of coordinates.
void require_same_triangles(const textured_surface& a, const textured_surface& b);

} // namespace taut::tools
