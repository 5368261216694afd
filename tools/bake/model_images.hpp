// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <taut/gltf.hpp>
#include <taut/impl/files/gltf/images.hpp>

#include "bake/model_textures.hpp"

namespace taut::tools
{

/// Throws unsuitable_input unless a model has the textures of uses of another one at the same places, and its triangles
/// the same materials; io_error where it is malformed.
void require_same_textures(const io::gltf_model& old, const io::gltf_model& next,
                           const std::vector<model_texture>& uses);

/// Which images of a model the new ones of uses become: those in their place, where every texture that names an image
/// is one of a use; else a new one. Throws io_error.
std::vector<std::vector<std::size_t>> places_of_images(const io::gltf_model& model,
                                                       const std::vector<model_texture>& uses);

/// Has the materials of a document show other images through another set of texture coordinates. images: those of each
/// use, as places_of_images() says. Where there are normals or directions, tangents of vertices are taken out: they are
/// of the old atlas. Notes: extensions that name images of other formats, which are taken out.
void show_images(io::impl::gltf_json& document, const io::gltf_model& model, const std::vector<model_texture>& uses,
                 const std::vector<std::vector<std::size_t>>& images, int texcoord_set,
                 std::vector<std::string>& notes);

} // namespace taut::tools
