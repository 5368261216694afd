// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <taut/impl/bake/texture.hpp>
#include <taut/impl/gltf/gltf.hpp>

namespace taut::tools
{

/// Meanings of the numbers of a texture.
enum class texture_content
{
    colour, ///< encoded as sRGB, but for alpha and in EXR
    data,   ///< as they are: roughness, occlusion, masks, heights
    normal  ///< in tangent space
};

/// A use of an image by materials of a model: how its numbers are meant and which triangles show it.
struct model_texture
{
    std::size_t image = 0;
    std::string name; ///< for people
    texture_content content = texture_content::data;
    texture::wrap wrap = texture::wrap::repeat;
    std::array<double, 5> transform{0, 0, 0, 1, 1};          ///< KHR_texture_transform: offset, rotation, scale
    std::vector<io::impl::gltf_json::json_pointer> places{}; ///< of the textureInfos in the document
    std::vector<std::array<std::size_t, 2>> shown{};         ///< ranges of triangles: the first, and how many

    /// The transform of texture coordinates whose v runs upwards.
    vec2 place(vec2 uv) const;
};

/// The textures of the materials of a model that have texture coordinates of one set, by use. Notes: textures of
/// others. Throws io_error.
std::vector<model_texture> textures_of(const io::gltf_model& model, int texcoord_set, std::vector<std::string>& notes);

/// Has the materials of a document show other images through another set of texture coordinates. images: of each use,
/// the number of its image. Where there are normal maps, tangents of vertices are taken out: they are of the old atlas.
void show_images(io::impl::gltf_json& document, const std::vector<model_texture>& uses,
                 const std::vector<std::size_t>& images, int texcoord_set);

} // namespace taut::tools
