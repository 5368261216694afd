// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <taut/impl/files/file/byte_order.hpp>
#include <taut/impl/files/file/read_file.hpp>
#include <taut/impl/files/gltf/source.hpp>
#include <taut/impl/files/gltf/uri.hpp>

/// A glTF document and its buffers taken from a file, and put into one.
namespace taut::io::impl
{

constexpr std::uint32_t glb_magic = 0x46546c67, glb_json = 0x4e4f534a, glb_bin = 0x004e4942; // glTF, JSON, BIN

inline std::uint32_t load_u32(std::string_view bytes, std::size_t at)
{
    return load<std::uint32_t>(bytes.data() + at, std::endian::little);
}

inline void append_u32(std::string& bytes, std::size_t x)
{
    char four[4];
    store(four, static_cast<std::uint32_t>(x), std::endian::little);
    bytes.append(four, 4);
}

inline bool is_glb(std::string_view bytes)
{
    return bytes.size() >= 4 && load_u32(bytes, 0) == glb_magic;
}

/// The chunks of a GLB file: the JSON, the binary one if there is one, and others as they are.
struct glb_chunks
{
    std::string_view json;
    std::optional<std::string_view> bin = {};
    std::vector<std::string> more = {};
};

inline glb_chunks split_glb(std::string_view bytes, const std::string& path)
{
    const auto fail = [&](const std::string& what, std::size_t at) {
        throw io_error(path, what, file_place{file_place::byte, at});
    };
    if (bytes.size() < 20)
        fail("the file ends in the head of GLB; the file is damaged or cut off, get or save it again", bytes.size());
    if (const auto version = load_u32(bytes, 4); version != 2)
        fail("GLB of version " + std::to_string(version) + "; convert it to glTF 2.0", 4);
    const std::size_t length = load_u32(bytes, 8);
    if (length > bytes.size())
        fail("the file has " + std::to_string(bytes.size()) + " bytes, not the " + std::to_string(length) +
                 " that it says; the file is damaged or cut off, get or save it again",
             8);
    glb_chunks chunks;
    for (std::size_t at = 12, count = 0; at + 8 <= length; ++count)
    {
        const std::size_t size = load_u32(bytes, at);
        const auto type = load_u32(bytes, at + 4);
        if (size > length - at - 8)
            fail("a chunk of " + std::to_string(size) +
                     " bytes goes beyond the end; the file is damaged or cut off, get or save it again",
                 at);
        const auto content = bytes.substr(at + 8, size);
        if ((count == 0) != (type == glb_json))
            fail("the first chunk, and no other, must be JSON; export the model again", at);
        if (type == glb_json)
            chunks.json = content;
        else if (type == glb_bin && count == 1)
            chunks.bin = content;
        else
            chunks.more.emplace_back(bytes.substr(at, 8 + size));
        at += 8 + size;
    }
    return chunks;
}

/// A GLB file. Throws io_error where it would be longer than its 32 bits can say.
inline std::string join_glb(std::string json, std::string_view bin, const std::vector<std::string>& more,
                            const std::string& path)
{
    json.append((4 - json.size() % 4) % 4, ' ');
    const std::size_t padding = (4 - bin.size() % 4) % 4;
    std::size_t length = 12 + 8 + json.size() + (bin.empty() ? 0 : 8 + bin.size() + padding);
    for (const std::string& chunk : more) length += chunk.size();
    if (length > UINT32_MAX)
        throw io_error(path, "would have " + std::to_string(length >> 20) +
                                 " MiB, more than GLB can; write .gltf, which has its data in a file of its own");
    std::string bytes;
    bytes.reserve(length);
    append_u32(bytes, glb_magic);
    append_u32(bytes, 2);
    append_u32(bytes, length);
    append_u32(bytes, json.size());
    append_u32(bytes, glb_json);
    bytes += json;
    if (!bin.empty())
    {
        append_u32(bytes, bin.size() + padding);
        append_u32(bytes, glb_bin);
        bytes.append(bin).append(padding, '\0');
    }
    for (const std::string& chunk : more) bytes += chunk;
    return bytes;
}

/// Path of the file of a buffer, which must be in the folder of the document, as models are untrusted. Throws io_error.
inline std::filesystem::path file_of_buffer(const gltf_source& source, const gltf_object& buffer,
                                            const std::string& uri)
{
    namespace fs = std::filesystem;
    const auto refuse = [&](const char* why)
    { buffer.fail("lies in " + uri.substr(0, 80) + ", " + why + "; put the file itself beside the document"); };
    if (has_scheme(uri)) buffer.fail("lies at " + uri.substr(0, 80) + "; fetch it to a file beside the document");
    const std::string name = percent_decoded(uri);
    const fs::path relative = name, folder = fs::path(source.path).parent_path(), file = folder / relative;
    if (name.find('\\') != name.npos || name.find('\0') != name.npos) refuse("which is no path of a URI");
    if (relative.has_root_path() || std::find(relative.begin(), relative.end(), "..") != relative.end())
        refuse("outside of the folder of the document");
    std::error_code unknown;
    if (!fs::is_regular_file(file, unknown))
        buffer.fail("lies in " + file.string() + ", which is no file; put it there");
    auto real = path_within(folder, file);
    if (!real) refuse("a link out of the folder of the document");
    return std::move(*real);
}

/// The bytes of buffer i, of which the document says what it needs.
inline std::string load_buffer(gltf_source& source, std::size_t i, std::optional<std::string_view> bin)
{
    const gltf_object buffer = item_of(source, "buffers", i);
    const std::size_t length = buffer.whole("byteLength");
    std::string bytes;
    if (!buffer.find("uri"))
    {
        if (i > 0 || !bin)
            buffer.fail("has no uri, and there is no binary chunk for it; give it one, or save the model as .glb");
        bytes = *bin;
    }
    else
    {
        const std::string& uri = buffer.text("uri");
        if (is_data_uri(uri))
        {
            const auto comma = uri.find(";base64,");
            auto decoded = comma == uri.npos ? std::nullopt : from_base64(std::string_view(uri).substr(comma + 8));
            if (!decoded) buffer.fail("has a data URI that is no base64; export the model again");
            bytes = std::move(*decoded);
        }
        else
        {
            auto file = file_of_buffer(source, buffer, uri);
            bytes = read_file(file);
            if (!source.files.insert(std::move(file)).second)
                buffer.fail("lies in " + uri.substr(0, 80) + ", as another one does; join the two");
        }
    }
    if (bytes.size() < length)
        buffer.fail("has " + std::to_string(bytes.size()) + " bytes, not the " + std::to_string(length) +
                    " that the document says; put the file there that belongs to it");
    bytes.resize(length);
    return bytes;
}

/// Throws io_error if a bufferView is compressed, in a way that names places in buffers.
inline void require_uncompressed(const gltf_source& source)
{
    for (std::size_t i = 0; i < root_of(source).items("bufferViews").size(); ++i)
        if (const gltf_object view = item_of(source, "bufferViews", i); view.find("extensions"))
            for (const char* const name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
                if (view.object("extensions").find(name))
                    view.fail("is compressed with " + std::string(name) +
                              "; decompress the file, as gltf-transform does");
}

/// The document in the bytes of a .gltf or .glb file with all its buffers. Throws io_error.
inline gltf_source gltf_source_of(std::string_view bytes, const std::string& path)
{
    const glb_chunks chunks = is_glb(bytes) ? split_glb(bytes, path) : glb_chunks{bytes};
    gltf_source source{path, parse_gltf_json(chunks.json, path), {}, chunks.more};
    const std::string& version = root_of(source).object("asset").text("version");
    if (!version.starts_with("2."))
        throw io_error(path, "glTF " + version.substr(0, 20) + " is not read; convert it to glTF 2.0");
    require_uncompressed(source);
    const gltf_json& buffers = root_of(source).items("buffers");
    source.data_uris = !buffers.empty();
    std::vector<char> named(buffers.size(), 0);
    for (std::size_t i = 0; i < root_of(source).items("bufferViews").size(); ++i)
        if (const std::size_t buffer = item_of(source, "bufferViews", i).whole("buffer"); buffer < named.size())
            named[buffer] = 1;
    for (std::size_t i = 0; i < buffers.size(); ++i)
    {
        source.buffers.push_back(named[i] ? load_buffer(source, i, chunks.bin) : std::string());
        const gltf_json* const uri = item_of(source, "buffers", i).find("uri");
        source.data_uris =
            source.data_uris && uri && uri->is_string() && is_data_uri(uri->get_ref<const std::string&>());
    }
    return source;
}

/// Locations of the buffers of a document, and of its images.
struct buffer_places
{
    std::set<std::filesystem::path> files;  ///< of buffers, beside it
    std::set<std::filesystem::path> images; ///< of images, beside it; without those that are not there
    bool data_uris = false;                 ///< all in the document itself, as data URIs
};

/// The file of an image beside the document; nothing where it is in the document, or cannot be read.
inline std::optional<std::filesystem::path> file_of_image(const gltf_source& source, std::size_t number)
{
    try
    {
        const gltf_object image = item_of(source, "images", number);
        if (!image.find("uri") || is_data_uri(image.text("uri"))) return std::nullopt;
        return file_of_buffer(source, image, image.text("uri"));
    }
    catch (const io_error&)
    {
        return std::nullopt;
    }
}

/// The document is read but for its buffers; nothing where they cannot be told.
inline buffer_places places_of_buffers(const std::filesystem::path& path)
{
    buffer_places places;
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(path, unknown)) return places; // a pipe would be waited for
    try
    {
        const std::string bytes = read_file(path);
        const glb_chunks chunks = is_glb(bytes) ? split_glb(bytes, path.string()) : glb_chunks{bytes};
        const gltf_source source{path.string(), parse_gltf_json(chunks.json, path.string())};
        const std::size_t count = root_of(source).items("buffers").size();
        std::size_t inside = 0;
        for (std::size_t i = 0; i < count; ++i)
            if (const gltf_object buffer = item_of(source, "buffers", i); buffer.find("uri"))
            {
                const std::string& uri = buffer.text("uri");
                if (is_data_uri(uri))
                    ++inside;
                else
                    places.files.insert(file_of_buffer(source, buffer, uri));
            }
        places.data_uris = count > 0 && inside == count;
        for (std::size_t i = 0; i < root_of(source).items("images").size(); ++i)
            if (const auto file = file_of_image(source, i)) places.images.insert(*file);
    }
    catch (const io_error&)
    {
        // It is no document, or not one that can be read: whatever lies beside it is not known to be its own.
    }
    return places;
}

} // namespace taut::io::impl
