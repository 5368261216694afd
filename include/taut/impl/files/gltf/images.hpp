// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/files.hpp>
#include <taut/gltf.hpp>
#include <taut/impl/files/gltf/container.hpp>
#include <taut/impl/files/gltf/edit.hpp>

/// Images of a glTF document, as the bytes of their files.
namespace taut::io::impl
{

/// The bytes of an image: of a bufferView, a data URI, or a file in the folder of the document. Throws io_error.
inline std::string image_bytes(const gltf_source& source, std::size_t number)
{
    const gltf_object image = item_of(source, "images", number);
    if (!image.find("uri")) return std::string(view_bytes(source, image.whole("bufferView")));
    const std::string& uri = image.text("uri");
    if (!is_data_uri(uri)) return read_file(file_of_buffer(source, image, uri));
    const auto comma = uri.find(";base64,");
    auto decoded = comma == uri.npos ? std::nullopt : from_base64(std::string_view(uri).substr(comma + 8));
    if (!decoded) image.fail("has a data URI that is no base64; export the model again");
    return std::move(*decoded);
}

/// An image that is new, or takes the place of others.
struct new_image
{
    std::vector<std::size_t> numbers; ///< that it gets; those from the number of images of the document on are new
    std::string bytes;                ///< of a PNG file
    std::string name = {};            ///< of one that is new
};

/// Encodes a model with other images as the files to be written, as gltf_files() does. Images become bufferViews.
/// change: what else is done to the document
std::vector<file_to_write> files_with_images(const std::filesystem::path& path, const gltf_model& model,
                                             std::vector<new_image> images,
                                             const std::function<void(gltf_json&)>& change);

} // namespace taut::io::impl
