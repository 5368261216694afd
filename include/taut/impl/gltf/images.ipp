// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/gltf/images.hpp>
#include <taut/impl/gltf/write_gltf.ipp>

namespace taut::io::impl
{

std::vector<file_to_write> files_with_images(const std::filesystem::path& path, const gltf_model& model,
                                             std::vector<new_image> images,
                                             const std::function<void(gltf_json&)>& change)
{
    const auto data = gltf_data_file(path, model.source);
    gltf_edit edit(model.source);
    gltf_json& list = edit.document()["images"];
    for (new_image& image : images)
    {
        gltf_json entry = image.number < list.size() ? list[image.number] : gltf_json::object();
        entry.erase("uri");
        entry["mimeType"] = "image/png";
        entry["bufferView"] = edit.add_image(std::move(image.bytes));
        if (image.number < list.size())
            list[image.number] = std::move(entry);
        else
            list.push_back(std::move(entry));
    }
    change(edit.document());
    std::string bytes = edit.finish();
    return files_of_document(path, model, data, std::move(edit.document()), std::move(bytes));
}

} // namespace taut::io::impl
