// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/files.hpp>
#include <taut/gltf.hpp>
#include <taut/impl/files/gltf/gltf.hpp>
#include <taut/repair.hpp>
#include <taut/surface_file.hpp>

namespace taut::tools
{

/// Texture coordinates by corner of triangles, in the plane of the atlas.
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

    /// Surface to be mapped: the triangles of the file, or the repaired ones.
    const mesh<triangle>& surface() const { return repaired_ ? repaired_->surface : *whole_; }

    /// The points of the surface in the scene that the file is of, by whose lengths it is mapped.
    const std::vector<vec3>& points_in_scene() const { return placed_.empty() ? surface().points() : placed_; }
    bool is_placed() const { return !placed_.empty(); }

    /// The vertex of the file that a vertex of the surface is.
    idx vertex_origin(idx v) const { return repaired_ ? repaired_->vertex_origins[static_cast<std::size_t>(v)] : v; }

    /// The triangle of the file that a triangle of the surface is.
    idx cell_origin(idx c) const { return repaired_ ? repaired_->cell_origins[static_cast<std::size_t>(c)] : c; }

    /// Repairs of the input.
    std::span<const repair_finding> repairs() const
    {
        return repaired_ ? std::span<const repair_finding>(repaired_->findings) : std::span<const repair_finding>();
    }

    /// Texture coordinates of the file, in the plane of the atlas, one per corner of the surface; or empty.
    std::vector<std::array<vec2, 3>> texcoords() const;

    /// The same with what is no number where one is missing.
    std::vector<std::array<vec2, 3>> known_texcoords() const;

    /// The face of the file that each triangle is of.
    std::vector<idx> file_faces() const;

    /// A label a triangle where the file parts the surface, as by materials; or empty.
    virtual std::vector<idx> parts() const { return {}; }

    /// Names of meshes, nodes, materials, objects and groups of the file that have triangles in it.
    virtual std::set<std::string> part_names() const { return {}; }

    /// One flag per triangle of the surface: whether a part of this name has it.
    virtual std::vector<char> triangles_of(const std::string& name) const = 0;

    /// The number of the polygon that each triangle is of; or empty, if all faces are triangles.
    virtual std::vector<idx> polygons() const { return {}; }

    /// Polygons of the file that other programs turn over in this map (count_reversed_fans()).
    virtual std::size_t reversed_fans(const corner_map&) const { return 0; }

    /// The files to be written for this map of the surface. What was left out of the surface gets no coordinates, or in
    /// glTF one point. Throws no_valid_map if a polygon is in several charts.
    /// changes: gets what the files do not have as it was, in sentences
    virtual std::vector<io::file_to_write> files(const std::string& path, const corner_map& map,
                                                 io::gltf_model::numbers numbers,
                                                 std::vector<std::string>& changes) const = 0;

    idx file_vertices = 0, file_triangles = 0;
    std::vector<std::string> notes; ///< what was changed in reading, in sentences
    std::string near_edges;         ///< how many open edges the usual repair would sew; empty: none, or it has
    std::string texcoord_fault; ///< why the texture coordinates of the file are none here; empty: they are as it says

protected:
    /// origin: atlas_params::origin
    explicit atlas_source(vec2 origin) : origin_(origin) {}

    /// The plane of the atlas is that of OBJ, or {0, -1} below it, where v is -v of glTF: so nothing is rounded on the
    /// way from glTF to glTF.
    vec2 from_obj(vec2 x) const { return x + origin_; }
    vec2 to_obj(vec2 x) const { return x - origin_; }
    vec2 from_gltf(vec2 x) const { return {x.x, origin_.y + 1 - x.y}; }
    vec2 to_gltf(vec2 x) const { return {x.x, origin_.y + 1 - x.y}; }

    void take(mesh<triangle> whole) { whole_.emplace(std::move(whole)); }
    void take(repaired_surface repaired) { repaired_.emplace(std::move(repaired)); }
    void place(std::vector<vec3> points) { placed_ = std::move(points); }

    /// The triangle of the file and the corner of it that are corner k of triangle c of the surface.
    std::pair<std::size_t, std::size_t> origin(std::size_t c, std::size_t k) const
    {
        if (!repaired_) return {c, k};
        return {static_cast<std::size_t>(repaired_->cell_origins[c]), repaired_->corner_origin(c, k)};
    }

    /// The texture coordinate of a corner of a triangle of the file, in the plane of the atlas; nothing if it has none.
    virtual std::optional<vec2> texcoord(std::size_t cell, std::size_t corner) const = 0;

    /// The files of a model of glTF with this map of the surface. What has no place in it lies in one point.
    std::vector<io::file_to_write> gltf_files(const std::string& path, const io::gltf_model& model,
                                              const corner_map& map, int set, io::gltf_model::numbers numbers,
                                              std::vector<std::string>& changes) const;

    /// Says which triangles have mirrored images for those who read their corners as the file has them.
    void note_mirrored(std::vector<std::string>& changes) const;

private:
    vec2 origin_;
    std::optional<mesh<triangle>> whole_;      // of the file as it is,
    std::optional<repaired_surface> repaired_; // or this
    std::vector<vec3> placed_;                 // of it; none: as they are
};

struct source_options
{
    io::surface_format format{};
    bool repair = false;
    std::optional<double> weld; ///< repair_params::weld_tolerance; nothing: the usual one
    int texcoord_set = 0;       ///< of glTF: the set that is written,
    int read_texcoord_set = 0;  ///< and the one that is read
    vec2 origin = vec2(0.0);    ///< atlas_params::origin
    bool apart = false;         ///< each node of glTF that draws a mesh has one of its own
    bool in_scene = true;       ///< lengths of glTF are those of its scenes, not of its meshes
};

/// Throws io_error, mesh_error; repair_error if no triangle is left.
std::unique_ptr<atlas_source> open_atlas_source(const std::string& path, const source_options& options);

} // namespace taut::tools
