// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <taut/io/atomic_file.hpp>
#include <taut/io/read_surface.hpp>
#include <taut/mesh/mesh.hpp>

namespace taut::tools
{

/// Texture coordinates by corner of triangles.
struct corner_map
{
    std::span<const vec2> uv;
    std::span<const std::array<idx, 3>> cells; ///< into uv
};

/// A file with a surface that gets an atlas: what of it is mapped, and how it is written back.
class atlas_source
{
public:
    virtual ~atlas_source() = default;

    /// What is mapped.
    virtual const mesh<triangle>& surface() const = 0;

    /// The vertex of the file that a vertex of the surface is.
    virtual idx vertex_origin(idx v) const { return v; }

    /// The texture coordinates that the file has, one a corner of the surface; empty if one is missing.
    virtual std::vector<std::array<vec2, 3>> texcoords() const = 0;

    /// A label a triangle where the file parts the surface, as by materials; or empty.
    virtual std::vector<idx> parts() const { return {}; }

    /// Writes the file with this map of the surface. What was left out of the surface gets no coordinates.
    virtual void write(io::atomic_file& out, const corner_map& map) const = 0;

    idx file_vertices = 0, file_triangles = 0;
    std::vector<std::string> notes; ///< what was changed in reading, in sentences
    nlohmann::ordered_json repairs = nlohmann::ordered_json::array();
    std::vector<std::string> repair_lines;
};

struct source_options
{
    io::surface_format format{};
    bool repair = false;
    int texcoord_set = 0; ///< of glTF
};

/// Throws io_error, mesh_error; and what repair throws.
std::unique_ptr<atlas_source> open_atlas_source(const std::string& path, const source_options& options);

} // namespace taut::tools
