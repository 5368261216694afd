// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/files/gltf/edit.hpp>
#include <taut/impl/files/gltf/split_vertices.hpp>

/// Accessors of a document that is written, each with bufferViews of its own.
namespace taut::io::impl
{

constexpr unsigned gltf_vertex_target = 34962, gltf_index_target = 34963;

/// Numbers as little-endian bytes.
template <class T, class Values>
std::string bytes_of(const Values& values)
{
    std::string bytes(values.size() * sizeof(T), '\0');
    for (std::size_t i = 0; i < values.size(); ++i)
        store(bytes.data() + i * sizeof(T), static_cast<T>(values[i]), std::endian::little);
    return bytes;
}

/// type: floats, or unsigned shorts as fractions
inline std::string texcoord_bytes(const std::vector<gltf_texcoord>& uv, gltf_component type)
{
    std::vector<double> numbers;
    numbers.reserve(2 * uv.size());
    for (const gltf_texcoord& x : uv)
        for (const double t : x) numbers.push_back(type == gltf_f32 ? t : std::round(t * 65535));
    return type == gltf_f32 ? bytes_of<float>(numbers) : bytes_of<std::uint16_t>(numbers);
}

template <class Values>
std::string index_bytes(const Values& values, gltf_component type)
{
    return type == gltf_u8    ? bytes_of<std::uint8_t>(values)
           : type == gltf_u16 ? bytes_of<std::uint16_t>(values)
                              : bytes_of<std::uint32_t>(values);
}

/// The old type of indices if it can say `most`, else the smallest of 16 bits and more that can.
inline gltf_component type_for(std::size_t most, gltf_component old)
{
    const auto holds = [most](gltf_component type) { return size_of(type) == 4 || most >> 8 * size_of(type) == 0; };
    return holds(old) ? old : holds(gltf_u16) ? gltf_u16 : gltf_u32;
}

/// An old accessor with its name and the like, but for what says where its elements lie and which they are.
inline gltf_json accessor_like(const gltf_source& source, std::size_t old)
{
    gltf_json a = old == gltf_edit::nothing ? gltf_json::object() : source.document["accessors"][old];
    for (const char* const key : {"byteOffset", "normalized", "min", "max", "sparse"}) a.erase(key);
    return a;
}

/// The bufferView of an accessor, in which its elements lie alone at multiples of 4 bytes, as attributes must.
inline std::size_t add_vertex_view(gltf_edit& edit, const gltf_source& source, const gltf_elements& old,
                                   std::size_t count, std::span<const std::uint32_t> origins)
{
    const std::string elements = packed(source, old, count);
    const std::size_t stride = (old.size + 3) / 4 * 4;
    std::string bytes((count + origins.size()) * stride, '\0');
    for (std::size_t i = 0; i < count + origins.size(); ++i)
        std::copy_n(elements.data() + (i < count ? i : origins[i - count]) * old.size, old.size,
                    bytes.data() + i * stride);
    gltf_json members = gltf_json::object();
    if (stride != old.size) members["byteStride"] = stride;
    return edit.add_view(std::move(bytes), members, &old.view);
}

/// The sparse elements of an accessor that is continued, those of the new vertices at the end.
inline void grow_sparse(gltf_edit& edit, const gltf_source& source, gltf_json& a, const gltf_accessor& old,
                        std::span<const std::uint32_t> origins)
{
    const std::string old_indices = packed(source, old.sparse->indices, old.sparse->count);
    std::string values = packed(source, old.sparse->values, old.sparse->count);
    std::vector<std::size_t> indices;
    std::map<std::size_t, std::size_t> slot; // of each index, the last where it stands twice
    for (std::size_t k = 0; k < old.sparse->count; ++k)
    {
        indices.push_back(load_index(old_indices, old.sparse->index_type, k));
        slot[indices[k]] = k;
    }
    for (std::size_t i = 0; i < origins.size(); ++i)
        if (const auto at = slot.find(origins[i]); at != slot.end())
        {
            indices.push_back(old.count + i);
            values += values.substr(at->second * old.size, old.size);
        }
    if (indices.size() == old.sparse->count) return;
    const gltf_component type = type_for(indices.back(), old.sparse->index_type);
    gltf_json& sparse = a["sparse"];
    sparse["count"] = indices.size();
    sparse["indices"]["bufferView"] =
        edit.add_view(index_bytes(indices, type), gltf_json::object(), &old.sparse->indices.view);
    sparse["indices"]["componentType"] = type;
    sparse["values"]["bufferView"] = edit.add_view(std::move(values), gltf_json::object(), &old.sparse->values.view);
    for (const char* const part : {"indices", "values"}) sparse[part].erase("byteOffset");
}

/// An accessor continued by copies of some of its elements, bit for bit.
inline gltf_json grown_accessor(gltf_edit& edit, const gltf_source& source, std::size_t number,
                                std::span<const std::uint32_t> origins)
{
    const gltf_accessor old = accessor_of(source, number);
    edit.spend(sizeof(float) * origins.size() + (old.base ? old.count * old.size : 0) +
               (old.sparse ? old.sparse->count * (old.size + sizeof(float)) : 0));
    gltf_json a = source.document["accessors"][number];
    if (old.base)
    {
        a["bufferView"] = add_vertex_view(edit, source, *old.base, old.count, origins);
        a.erase("byteOffset");
    }
    if (old.sparse) grow_sparse(edit, source, a, old, origins);
    a["count"] = old.count + origins.size();
    return a;
}

/// An accessor of texture coordinates. old: one whose place it takes, or nothing
inline gltf_json texcoord_accessor(gltf_edit& edit, const gltf_source& source, std::size_t old,
                                   const std::vector<gltf_texcoord>& uv, gltf_component type)
{
    gltf_json a = accessor_like(source, old);
    a["bufferView"] = edit.add_view(texcoord_bytes(uv, type), {{"target", gltf_vertex_target}});
    a["componentType"] = type;
    a["count"] = uv.size();
    a["type"] = "VEC2";
    if (type != gltf_f32) a["normalized"] = true;
    return a;
}

/// An accessor of the indices that a primitive draws. old: one whose place and type it takes where it can, or nothing
/// most: the number of the last vertex
inline gltf_json index_accessor(gltf_edit& edit, const gltf_source& source, std::size_t old,
                                std::span<const std::uint32_t> drawn, std::size_t most)
{
    // The largest number of a type has a meaning of its own.
    const auto type = type_for(most + 1, old == gltf_edit::nothing ? gltf_u16 : accessor_of(source, old).component);
    gltf_json a = accessor_like(source, old);
    a["bufferView"] = edit.add_view(index_bytes(drawn, type), {{"target", gltf_index_target}});
    a["componentType"] = type;
    a["count"] = drawn.size();
    a["type"] = "SCALAR";
    return a;
}

} // namespace taut::io::impl
