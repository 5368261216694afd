// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_GLTF
#endif
#ifndef TAUT_GLTF_HPP
#define TAUT_GLTF_HPP

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <taut/impl/files/gltf/source.hpp>
#include <taut/types.hpp>

/// glTF models; everything except texture coordinates is preserved. Needs nlohmann-json.
namespace taut::io
{

/// Model of a glTF file: the triangles of all its meshes, in its order, and the file itself.
///
/// Corners of a mesh with equal coordinates are one point, although glTF splits vertices for normals, texture
/// coordinates and materials. Points of different meshes are not welded. Coordinates are those of meshes: a mesh drawn
/// by several nodes appears once, and the scale of nodes is ignored. Strips and fans are triangles; points and lines
/// are left out, and so are primitives that draw the same triangles as an earlier one.
struct gltf_model
{
    /// Number format of written texture coordinates.
    enum class numbers
    {
        floats,
        fractions ///< multiples of 1/65535, from 0 to 1: unsigned shorts, normalized
    };

    std::vector<vec3> points; ///< those that triangles name, in the order of first appearance; may be not finite
    std::vector<std::array<idx, 3>> triangles; ///< vertex indices into points; may name one twice, or have no area
    std::vector<std::array<idx, 3>> vertices;  ///< the vertex of glTF at each corner: those that share attributes are
                                               ///< numbered one after the other
    std::vector<idx> meshes;                   ///< mesh of each triangle
    std::vector<idx> materials;                ///< material of each triangle; -1: none
    std::vector<vec2> texcoords; ///< texture coordinates of the requested set, as in the file: v runs downwards
    std::vector<std::array<idx, 3>> texcoord_cells; ///< one triple per triangle, into texcoords; -1: none
    std::vector<std::string> notes;                 ///< changes in reading or making it, in sentences
    impl::gltf_source source;                       ///< the file

    gltf_model() = default;

    /// Makes a new document of a surface, to be written with texture coordinates: one mesh, points as floats in their
    /// order, normals weighted by area, and an attribute _SOURCE_VERTEX that tells the point of each vertex: two
    /// unsigned shorts, the lower and the upper 16 bits of its number. Triangles keep their numbers; one with a missing
    /// or non-finite point draws nothing.
    ///
    /// Points farther from 0 than the surface is large, or where floats end, are relative to a node with a translation,
    /// and a scale if need be, which are doubles: rounding moves nothing by more than 2e-7 of its size. A note counts
    /// triangles that have no area in floats all the same. Throws mesh_error (empty).
    gltf_model(std::span<const vec3> surface_points, std::span<const std::array<idx, 3>> surface_triangles);

    /// Rounds texture coordinates to the numbers of a file, which are read back bit for bit. Certify these rather than
    /// the unrounded ones.
    static vec2 rounded(vec2 uv, numbers as = numbers::floats);

    /// The same with v upwards, for atlas_params::stored beside the origin {0, -1}: the numbers of (u, -v).
    template <numbers As = numbers::floats>
    static vec2 stored(vec2 uv)
    {
        const vec2 x = rounded({uv.x, -uv.y}, As);
        return {x.x, -x.y};
    }

    /// Writes the model with new texture coordinates; its files appear together or not at all.
    /// corner_uv: one per corner of triangles, v downwards. Throws io_error, parameter_error.
    void write(const std::filesystem::path& path, std::span<const std::array<vec2, 3>> corner_uv, int texcoord_set = 0,
               numbers as = numbers::floats) const;
};

/// Returns whether a file name ends in .gltf or .glb, in either case.
bool is_gltf(const std::filesystem::path& path);

/// Reads a .gltf file with its buffers, or a .glb file; the bytes tell which. Coordinates may be quantized
/// (KHR_mesh_quantization) and sparse. No file is read but the document and the buffers that its bufferViews name,
/// which lie in its folder. Memory and time are bounded by the bytes of these. texcoord_set: the N of TEXCOORD_N that
/// texcoords are read from. Throws io_error: unreadable, malformed, buffers that lie elsewhere, or compressed with
/// Draco or meshopt; mesh_error (empty) without triangles.
gltf_model read_gltf(const std::filesystem::path& path, int texcoord_set = 0);

} // namespace taut::io

#endif
#include <taut/impl/leave.inl>
