// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/files/gltf/images.hpp>
#include <taut/impl/files/gltf/write_gltf.ipp>

namespace taut::io::impl
{

std::vector<file_to_write> files_with_images(const std::filesystem::path& path, const gltf_model& model,
                                             std::vector<new_image> images,
                                             const std::function<void(gltf_json&)>& change)
{
    const auto data = gltf_data_file(path, model.source);
    gltf_edit edit(model.source);
    const std::size_t old = root_of(model.source).items("images").size();
    for (new_image& image : images)
    {
        const std::size_t view = edit.add_image(std::move(image.bytes));
        for (const std::size_t number : image.numbers)
        {
            if (number < old) item_of(model.source, "images", number); // is an object
            gltf_json& list = edit.document()["images"];
            gltf_json entry = number < old ? list[number] : gltf_json::object();
            if (number >= old && !image.name.empty()) entry["name"] = image.name;
            entry.erase("uri");
            entry["mimeType"] = "image/png";
            entry["bufferView"] = view;
            if (number < old)
                list[number] = std::move(entry);
            else
                list.push_back(std::move(entry));
        }
    }
    change(edit.document());
    std::string bytes = edit.finish();
    return files_of_document(path, model, data, std::move(edit.document()), std::move(bytes));
}

} // namespace taut::io::impl
