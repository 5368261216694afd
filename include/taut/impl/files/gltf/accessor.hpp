// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <taut/impl/files/file/byte_order.hpp>
#include <taut/impl/files/gltf/source.hpp>

/// Arrays of a glTF document.
namespace taut::io::impl
{

/// The types of numbers, by the codes of glTF.
enum gltf_component : unsigned
{
    gltf_i8 = 5120,
    gltf_u8 = 5121,
    gltf_i16 = 5122,
    gltf_u16 = 5123,
    gltf_u32 = 5125,
    gltf_f32 = 5126
};

/// Bytes of a number; 0: no such type.
inline std::size_t size_of(gltf_component c)
{
    switch (c)
    {
    case gltf_i8:
    case gltf_u8:
        return 1;
    case gltf_i16:
    case gltf_u16:
        return 2;
    case gltf_u32:
    case gltf_f32:
        return 4;
    }
    return 0;
}

/// Elements at regular distances in a bufferView.
struct gltf_elements
{
    std::size_t view;
    std::size_t offset; ///< in the view
    std::size_t size;   ///< bytes of an element
    std::size_t stride; ///< bytes from one to the next
};

/// The elements of an accessor that differ from those in its bufferView.
struct gltf_sparse
{
    std::size_t count;
    gltf_component index_type;
    gltf_elements indices, values;
};

/// An accessor, whose elements lie in the buffers.
struct gltf_accessor
{
    std::string type; ///< SCALAR, VEC2, ...
    gltf_component component;
    bool normalized;
    std::size_t count;
    std::size_t size;                  ///< bytes of an element
    std::optional<gltf_elements> base; ///< none: all bytes are 0
    std::optional<gltf_sparse> sparse;
};

/// Bytes of an element; columns of matrices begin at multiples of 4. 0: no such type.
inline std::size_t element_size(std::string_view type, gltf_component component)
{
    const std::size_t size = size_of(component);
    const auto matrix = [size](std::size_t n) { return n * ((n * size + 3) / 4 * 4); };
    return type == "SCALAR" ? size
           : type == "VEC2" ? 2 * size
           : type == "VEC3" ? 3 * size
           : type == "VEC4" ? 4 * size
           : type == "MAT2" ? matrix(2)
           : type == "MAT3" ? matrix(3)
           : type == "MAT4" ? matrix(4)
                            : 0;
}

/// The bytes of a bufferView. Throws io_error if it is not inside its buffer.
inline std::string_view view_bytes(const gltf_source& source, std::size_t i)
{
    const gltf_object view = item_of(source, "bufferViews", i);
    const std::size_t buffer = view.whole("buffer"), offset = view.whole("byteOffset", 0),
                      length = view.whole("byteLength");
    if (buffer >= source.buffers.size())
        view.fail("names buffer " + std::to_string(buffer) + " of " + std::to_string(source.buffers.size()) +
                  ", counted from 0; name one that is there");
    const std::string_view bytes = source.buffers[buffer];
    if (offset > bytes.size() || length > bytes.size() - offset)
        view.fail(
            "goes beyond the end of its buffer; correct its byteOffset and byteLength, or export the model again");
    return bytes.substr(offset, length);
}

/// Throws io_error unless `count` elements lie in their view.
inline gltf_elements elements_in(const gltf_source& source, const gltf_object& owner, std::size_t count,
                                 std::size_t size)
{
    const std::size_t view = owner.whole("bufferView"), offset = owner.whole("byteOffset", 0);
    const std::size_t length = view_bytes(source, view).size();
    const std::size_t stride = item_of(source, "bufferViews", view).whole("byteStride", size);
    if (stride < size)
        owner.fail("has elements that lie on top of each other, by the byteStride of its bufferView; correct that");
    if (count > 0 && (offset > length || size > length - offset || count - 1 > (length - offset - size) / stride))
        owner.fail("goes beyond the end of bufferView " + std::to_string(view) +
                   "; correct its count, or export the model again");
    return {view, offset, size, stride};
}

inline gltf_component component_of(const gltf_object& owner)
{
    const auto component = static_cast<gltf_component>(owner.whole("componentType"));
    if (size_of(component) == 0)
        owner.fail("has numbers of an unknown componentType; it must be 5120 to 5126 but for 5124");
    return component;
}

/// Accessor i. Throws io_error where it is not what it should be.
inline gltf_accessor accessor_of(const gltf_source& source, std::size_t i)
{
    const gltf_object object = item_of(source, "accessors", i);
    gltf_accessor a{object.text("type"), component_of(object), false, object.whole("count"), 0, {}, {}};
    a.size = element_size(a.type, a.component);
    if (a.size == 0) object.fail("is of an unknown type; it must be SCALAR, VEC2 to VEC4 or MAT2 to MAT4");
    if (const gltf_json* const n = object.find("normalized")) a.normalized = n->is_boolean() && n->get<bool>();
    if (object.find("bufferView")) a.base = elements_in(source, object, a.count, a.size);
    if (object.find("sparse"))
    {
        const gltf_object sparse = object.object("sparse"), indices = sparse.object("indices");
        const std::size_t count = sparse.whole("count");
        const gltf_component type = component_of(indices);
        if (type != gltf_u8 && type != gltf_u16 && type != gltf_u32)
            indices.fail("are no unsigned whole numbers; save them as componentType 5121, 5123 or 5125");
        a.sparse = gltf_sparse{count, type, elements_in(source, indices, count, size_of(type)),
                               elements_in(source, sparse.object("values"), count, a.size)};
        if (count > a.count) sparse.fail("has more elements than its accessor; correct its count");
    }
    return a;
}

/// The elements one after the other, without gaps.
inline std::string packed(const gltf_source& source, const gltf_elements& e, std::size_t count)
{
    const std::string_view bytes = view_bytes(source, e.view);
    if (e.stride == e.size) return std::string(bytes.substr(count > 0 ? e.offset : 0, count * e.size));
    std::string all;
    all.reserve(count * e.size);
    for (std::size_t i = 0; i < count; ++i) all.append(bytes.substr(e.offset + i * e.stride, e.size));
    return all;
}

/// An unsigned whole number of a type that is one.
inline std::size_t load_index(std::string_view bytes, gltf_component type, std::size_t i)
{
    const char* const at = bytes.data() + i * size_of(type);
    return type == gltf_u8    ? load<std::uint8_t>(at, std::endian::little)
           : type == gltf_u16 ? load<std::uint16_t>(at, std::endian::little)
                              : load<std::uint32_t>(at, std::endian::little);
}

/// All elements of an accessor as they count, one after the other. Throws io_error for sparse ones beyond the end.
inline std::string all_elements(const gltf_source& source, const gltf_accessor& a, const std::string& name)
{
    std::string all = a.base ? packed(source, *a.base, a.count) : std::string(a.count * a.size, '\0');
    if (!a.sparse) return all;
    const std::string indices = packed(source, a.sparse->indices, a.sparse->count),
                      values = packed(source, a.sparse->values, a.sparse->count);
    for (std::size_t k = 0; k < a.sparse->count; ++k)
    {
        const std::size_t i = load_index(indices, a.sparse->index_type, k);
        if (i >= a.count)
            throw io_error(source.path,
                           name + " has sparse element " + std::to_string(i) + " of " + std::to_string(a.count));
        std::copy_n(values.data() + k * a.size, a.size, all.data() + i * a.size);
    }
    return all;
}

/// Number k of elements that all_elements gave, whole numbers that are normalized as fractions.
inline double load_number(std::string_view elements, const gltf_accessor& a, std::size_t k)
{
    const char* const at = elements.data() + k * size_of(a.component);
    const auto fraction = [&](double x, double most) { return a.normalized ? std::max(x / most, -1.0) : x; };
    switch (a.component)
    {
    case gltf_i8:
        return fraction(load<std::int8_t>(at, std::endian::little), 127);
    case gltf_u8:
        return fraction(load<std::uint8_t>(at, std::endian::little), 255);
    case gltf_i16:
        return fraction(load<std::int16_t>(at, std::endian::little), 32767);
    case gltf_u16:
        return fraction(load<std::uint16_t>(at, std::endian::little), 65535);
    case gltf_u32:
        return load<std::uint32_t>(at, std::endian::little);
    case gltf_f32:
        return static_cast<double>(load<float>(at, std::endian::little));
    }
    return 0;
}

} // namespace taut::io::impl
