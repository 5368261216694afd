// SPDX-License-Identifier: MIT
#include "shared/companions.hpp"

#include <string>
#include <system_error>

#include <taut/impl/gltf/container.hpp>
#include <taut/impl/gltf/gltf.hpp>

#include "shared/outputs.hpp"

namespace taut::tools
{

namespace
{

namespace fs = std::filesystem;

bool is_there(const fs::path& file)
{
    std::error_code ignored;
    return fs::is_regular_file(file, ignored);
}

bool is_tetgen(const fs::path& file)
{
    const auto e = extension(file);
    return e == ".node" || e == ".ele" || e == ".face";
}

fs::path named(fs::path file, const char* extension)
{
    return file.replace_extension(extension);
}

/// TetGen's files of a mesh.
std::vector<fs::path> tetgen_files(const fs::path& mesh, bool faces)
{
    std::vector<fs::path> files = {named(mesh, ".node"), named(mesh, ".ele")};
    if (faces) files.push_back(named(mesh, ".face"));
    return files;
}

bool has_faces(const fs::path& mesh)
{
    return is_there(named(mesh, ".face"));
}

} // namespace

std::vector<fs::path> companions_of(const fs::path& mesh, bool images)
{
    std::vector<fs::path> files;
    if (is_tetgen(mesh)) files = tetgen_files(mesh, has_faces(mesh));
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
    if (is_tetgen(source)) return tetgen_files(output, has_faces(source));
    const bool inside = io::is_gltf(source) && io::impl::places_of_buffers(source).data_uris;
    return extension(output) == ".gltf" && !inside ? std::vector{output, named(output, ".bin")} : std::vector{output};
}

fs::path stray_companion(const fs::path& output, const fs::path& source)
{
    return is_tetgen(source) && has_faces(output) && !has_faces(source) ? named(output, ".face") : fs::path();
}

} // namespace taut::tools
