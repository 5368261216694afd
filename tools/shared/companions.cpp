// SPDX-License-Identifier: MIT
#include "shared/companions.hpp"

#include <system_error>

#include <taut/gltf.hpp>
#include <taut/impl/files/gltf/container.hpp>
#include <taut/impl/files/volume/formats.hpp>

#include "shared/outputs.hpp"

namespace taut::tools
{

namespace fs = std::filesystem;

bool is_tetgen(const fs::path& file)
{
    return io::impl::volume_format_of_name(file) == io::volume_format::tetgen;
}

std::vector<fs::path> companions_of(const fs::path& mesh, bool images)
{
    auto files = io::impl::tetgen_files(mesh);
    if (io::is_gltf(mesh))
    {
        std::error_code unknown;
        const auto folder = mesh.parent_path();
        auto places = io::impl::places_of_buffers(mesh);
        if (images) places.files.merge(places.images);
        for (const auto& file : places.files) // named as the document is
            files.push_back(folder / fs::relative(file, folder.empty() ? "." : folder, unknown));
    }
    std::erase(files, mesh);
    return files;
}

std::vector<fs::path> written_as(const fs::path& output, const fs::path& source)
{
    if (is_tetgen(source)) return io::impl::tetgen_files(output, io::impl::tetgen_files(source).size() > 2);
    const bool inside = io::is_gltf(source) && io::impl::places_of_buffers(source).data_uris;
    return extension(output) == ".gltf" && !inside ? std::vector{output, fs::path(output).replace_extension(".bin")}
                                                   : std::vector{output};
}

} // namespace taut::tools
