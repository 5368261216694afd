// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <taut/bake.hpp>
#include <taut/gltf.hpp>
#include <taut/impl/files/gltf/primitives.hpp>

#include "bake/textured_surface.hpp"

namespace taut::tools
{

/// Meanings of the numbers of a texture.
enum class texture_content
{
    colour,   ///< encoded as sRGB, but for alpha and in EXR
    data,     ///< as they are: roughness, occlusion, masks, heights
    normal,   ///< in tangent space
    direction ///< across the normal, in tangent space, and its strength as the third number
};

/// Whether numbers are in tangent space, which an atlas turns.
inline bool is_turned(texture_content content)
{
    return content == texture_content::normal || content == texture_content::direction;
}

/// Triangles of a primitive as a texture is shown on them.
struct shown_part
{
    std::size_t count = 0;                          ///< of its triangles
    std::optional<std::size_t> texcoords = {};      ///< accessor, if it is not that of the primitive read
    std::size_t first_vertex = 0;                   ///< of the numbers in gltf_model::vertices
    bool other_frames = false;                      ///< normals or tangents are not those of the primitive read
    std::array<double, 5> transform{0, 0, 0, 1, 1}; ///< KHR_texture_transform: offset, rotation, scale

    bool operator==(const shown_part&) const = default;

    /// The transform of texture coordinates whose v runs upwards.
    vec2 place(vec2 uv) const;
};

/// A use of an image by materials of a model: how its numbers are meant and which triangles show it.
struct model_texture
{
    std::vector<std::size_t> images; ///< with the same bytes
    std::string name;                ///< for people
    texture_content content = texture_content::data;
    texture::wrap wrap_u = texture::wrap::repeat, wrap_v = texture::wrap::repeat;
    texture::filter filter = texture::filter::bilinear;
    double rotation = 0;                                     ///< of directions, added to those of the texture
    std::vector<io::impl::gltf_json::json_pointer> places{}; ///< of the textureInfos in the document
    std::set<idx> materials{};                               ///< that have them
    std::map<std::size_t, shown_part> shown{};               ///< by the first triangle
};

/// The texture coordinates of a part that has others than the primitive read, v upwards. first: its first triangle.
/// Throws io_error.
corner_uv texcoords_of(const io::gltf_model& model, std::size_t first, const shown_part& part);

/// Calls f(key, place) for each textureInfo below a value of a document: an object with an index, named ...Texture.
void for_each_texture(const io::impl::gltf_json& value, const io::impl::gltf_json::json_pointer& place,
                      const std::function<void(const std::string&, const io::impl::gltf_json::json_pointer&)>& f);

/// Whether a material has something in tangent space: normals, directions, or a grain that follows tangents.
bool needs_tangents(const io::impl::gltf_json& material);

/// Materials that a primitive is shown with: its own, and those of KHR_materials_variants. Throws io_error.
std::set<idx> materials_of(const io::gltf_model& model, const io::impl::gltf_primitive& primitive);

/// The textures of the materials of a model that have texture coordinates of one set, by use. Notes: textures of
/// others, and materials that nothing shows. Throws io_error; unsuitable_input for what an atlas changes and no texture
/// tells.
std::vector<model_texture> textures_of(const io::gltf_model& model, int texcoord_set, std::vector<std::string>& notes);

} // namespace taut::tools
