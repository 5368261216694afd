// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <taut/impl/bake/tangent_frames.hpp>
#include <taut/impl/core/types.hpp>
#include <taut/impl/gltf/gltf.hpp>
#include <taut/impl/io/read_surface.hpp>

namespace taut::tools
{

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
    std::vector<std::array<vec2, 3>> uv;         ///< v upwards; not a number where there is none
    std::vector<std::array<vec3, 3>> normals;    ///< unit vectors; those of the file, else smooth ones
    bool has_normals = false;                    ///< whether the file has them
    std::vector<impl::corner_tangents> tangents; ///< those of the file, if it has them for all corners
    std::optional<io::gltf_model> model;         ///< of glTF
    std::vector<std::string> notes;
};

/// Throws io_error, mesh_error.
textured_surface read_textured_surface(const std::string& path, io::surface_format format, int texcoord_set);

/// The colours of the vertices of a file: of PLY, OFF, or COLOR_0 of glTF. Throws unsuitable_input where it has none.
vertex_colours read_vertex_colours(const textured_surface& surface, io::surface_format format);

/// Throws unsuitable_input unless both have the same triangles in the same order, up to rounding of coordinates.
void require_same_triangles(const textured_surface& a, const textured_surface& b);

} // namespace taut::tools
