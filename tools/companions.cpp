// SPDX-License-Identifier: MIT
#include "companions.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <nlohmann/json.hpp>

#include <taut/gltf/detail/uri.hpp>
#include <taut/io/detail/byte_order.hpp>
#include <taut/io/read_file.hpp>

#include "outputs.hpp"

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

bool names_gltf(const fs::path& file)
{
    const auto e = extension(file);
    return e == ".gltf" || e == ".glb";
}

/// The JSON of a glTF document: all of its file, or the first chunk of GLB.
std::string json_of(const fs::path& document)
{
    std::error_code failure;
    std::uintmax_t length = fs::file_size(document, failure);
    std::ifstream in(document, std::ios::binary);
    std::array<char, 20> head{};
    if (failure || !in) return {};
    in.read(head.data(), head.size());
    if (in && std::string_view(head.data(), 4) == "glTF")
        length = std::min<std::uintmax_t>(io::detail::load<std::uint32_t>(head.data() + 12, std::endian::little),
                                          length - head.size());
    else
    {
        in.clear();
        in.seekg(0);
    }
    if (length > io::most_bytes_to_read()) return {}; // nor does anybody else read it
    std::string text(length, '\0');
    in.read(text.data(), static_cast<std::streamsize>(length));
    return text;
}

/// The uri of each buffer of a glTF document, empty where it has none. Nothing for what is no document.
std::vector<std::string> buffer_uris(const fs::path& document)
{
    using json = nlohmann::json;
    std::vector<std::string> uris;
    if (!is_there(document)) return uris;
    bool wanted = false; // all else is passed over
    const auto buffers_alone = [&](int depth, json::parse_event_t event, const json& parsed)
    {
        if (depth == 1 && event == json::parse_event_t::key) wanted = parsed == "buffers";
        return depth == 0 || wanted;
    };
    const auto root = json::parse(json_of(document), buffers_alone, false);
    const auto buffers = root.is_object() ? root.find("buffers") : root.end();
    if (buffers == root.end() || !buffers->is_array()) return uris;
    for (const json& buffer : *buffers)
        uris.push_back(buffer.is_object() && buffer.contains("uri") && buffer["uri"].is_string()
                           ? buffer["uri"].get<std::string>()
                           : std::string());
    return uris;
}

/// A file that a document names, if it lies in the document's folder: others are none of its.
std::optional<fs::path> beside(const fs::path& document, const std::string& uri)
{
    if (uri.empty() || io::detail::has_scheme(uri)) return {};
    std::error_code failure;
    const auto folder = document.parent_path();
    const auto file = folder / io::detail::percent_decoded(uri);
    const auto base = fs::weakly_canonical(folder.empty() ? "." : folder, failure);
    const auto full = fs::weakly_canonical(file, failure);
    const bool inside =
        !failure && std::mismatch(base.begin(), base.end(), full.begin(), full.end()).first == base.end();
    return inside ? std::optional(file) : std::nullopt;
}

} // namespace

std::vector<fs::path> companions_of(const fs::path& mesh)
{
    std::vector<fs::path> files;
    if (is_tetgen(mesh)) files = tetgen_files(mesh, has_faces(mesh));
    if (names_gltf(mesh))
        for (const auto& uri : buffer_uris(mesh))
            if (auto file = beside(mesh, uri)) files.push_back(std::move(*file));
    std::erase(files, mesh);
    return files;
}

std::vector<fs::path> written_as(const fs::path& output, const fs::path& source)
{
    if (is_tetgen(source)) return tetgen_files(output, has_faces(source));
    const auto uris = extension(output) == ".gltf" ? buffer_uris(source) : std::vector<std::string>();
    const auto is_data = [](const std::string& uri) { return uri.starts_with("data:"); };
    const bool one_file =
        extension(output) != ".gltf" || (!uris.empty() && std::all_of(uris.begin(), uris.end(), is_data));
    return one_file ? std::vector{output} : std::vector{output, named(output, ".bin")};
}

fs::path stray_companion(const fs::path& output, const fs::path& source)
{
    return is_tetgen(source) && has_faces(output) && !has_faces(source) ? named(output, ".face") : fs::path();
}

} // namespace taut::tools
