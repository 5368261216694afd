// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/impl/core/core/disjoint_sets.hpp>
#include <taut/impl/files/gltf/accessor.hpp>
#include <taut/types.hpp>

/// Primitives of the meshes of a glTF document.
namespace taut::io::impl
{

/// Names of attributes, and their accessors.
using gltf_attributes = std::vector<std::pair<std::string, std::size_t>>;

/// A primitive of a mesh.
struct gltf_primitive
{
    std::size_t mesh, number; ///< its place in the document
    std::string name;         ///< in messages
    gltf_attributes attributes;
    std::vector<gltf_attributes> targets; ///< of morphing
    std::optional<std::size_t> indices;
    std::size_t mode;
    idx material;                            ///< -1: none
    std::size_t vertices;                    ///< elements of each attribute
    std::size_t drawn;                       ///< indices, or vertices where there are none
    std::size_t pool = 0;                    ///< among the pools of the document
    std::size_t first = 0;                   ///< its first triangle among all
    std::size_t count = 0;                   ///< of its triangles; 0 for points, lines and copies
    std::optional<std::size_t> copy_of = {}; ///< an earlier primitive with the same triangles and texture coordinates
    std::optional<std::size_t> twin_of = {}; ///< the first one with the same triangles, which it has anew,
    std::size_t layer = 0;                   ///< and its number among those

    enum : std::size_t
    {
        triangles = 4,
        strip = 5,
        fan = 6
    };
    bool has_triangles() const { return mode >= triangles && mode <= fan; }

    /// Null if there is none.
    const std::size_t* attribute(const std::string& wanted) const
    {
        for (const auto& [key, accessor] : attributes)
            if (key == wanted) return &accessor;
        return nullptr;
    }
};

/// The primitives of a document in their order. Those that have accessors of attributes in common share one numbering
/// of vertices: a pool.
struct gltf_primitives
{
    std::vector<gltf_primitive> all;
    std::vector<std::size_t> first_vertex; ///< of each pool, in the numbering of all; #pools + 1
    std::size_t triangles = 0;

    /// The primitive whose triangles another one draws, be it a copy or a twin.
    const gltf_primitive& drawn_by(const gltf_primitive& p) const
    {
        const gltf_primitive& own = p.copy_of ? all[*p.copy_of] : p;
        return own.twin_of ? all[*own.twin_of] : own;
    }

    std::size_t vertices_of(std::size_t pool) const { return first_vertex[pool + 1] - first_vertex[pool]; }
};

inline gltf_attributes attributes_of(const gltf_json& value, const gltf_object& owner, const std::string& path)
{
    const gltf_object object(value, owner.name() + ", its attributes,", path);
    gltf_attributes attributes;
    for (const auto& [key, accessor] : value.items()) attributes.emplace_back(key, object.whole(accessor, key));
    return attributes;
}

/// Throws io_error where it is compressed, or not what it should be.
inline gltf_primitive primitive_of(const gltf_source& source, std::size_t mesh, std::size_t number)
{
    const gltf_json& items = item_of(source, "meshes", mesh).items("primitives");
    const std::string name = "primitive " + std::to_string(number) + " of mesh " + std::to_string(mesh);
    const gltf_object object(items[number], name, source.path);
    if (object.find("extensions") && object.object("extensions").find("KHR_draco_mesh_compression"))
        object.fail("is compressed with KHR_draco_mesh_compression; decompress the file, as gltf-transform does");
    gltf_primitive p{mesh, number, name, {}, {}, {}, object.whole("mode", gltf_primitive::triangles), -1, 0, 0};
    if (const gltf_json* const attributes = object.find("attributes"))
        p.attributes = attributes_of(*attributes, object, source.path);
    for (const gltf_json& target : object.items("targets"))
        p.targets.push_back(attributes_of(target, object, source.path));
    if (object.find("indices")) p.indices = object.whole("indices");
    if (object.find("material"))
        p.material = static_cast<idx>(std::min<std::size_t>(object.whole("material"), std::numeric_limits<idx>::max()));

    std::optional<std::size_t> count;
    const auto require_count = [&](const gltf_attributes& attributes)
    {
        for (const auto& attribute : attributes)
        {
            const std::size_t n = accessor_of(source, attribute.second).count;
            if (count.value_or(n) != n)
                object.fail("has attributes of different counts: " + attribute.first + "; give each one per vertex");
            count = n;
        }
    };
    require_count(p.attributes);
    for (const gltf_attributes& target : p.targets) require_count(target);
    p.vertices = p.drawn = count.value_or(0);
    if (!p.indices) return p;
    const gltf_accessor a = accessor_of(source, *p.indices);
    if (a.type != "SCALAR" || (a.component != gltf_u8 && a.component != gltf_u16 && a.component != gltf_u32))
        object.fail("has indices that are no unsigned whole numbers; save them as componentType 5121, 5123 or 5125");
    if (!a.base) object.fail("has indices without a bufferView; give them one");
    p.drawn = a.count;
    return p;
}

/// Calls f with the accessor of each attribute, targets included.
template <class Primitive, class F>
void for_each_attribute(Primitive& p, F f)
{
    for (auto& attribute : p.attributes) f(attribute.second);
    for (auto& target : p.targets)
        for (auto& attribute : target) f(attribute.second);
}

/// Joins the primitives that have accessors in common, and numbers what they make in the order of their first ones.
/// Throws io_error.
inline void make_pools(const gltf_source& source, gltf_primitives& primitives)
{
    auto& all = primitives.all;
    gltf_allowance vertices(source, 1);
    taut::impl::disjoint_sets sets(static_cast<idx>(all.size()));
    std::map<std::size_t, std::size_t> first_use; // of an accessor
    for (std::size_t i = 0; i < all.size(); ++i)
        for_each_attribute(all[i],
                           [&](std::size_t accessor)
                           {
                               const auto [use, is_new] = first_use.emplace(accessor, i);
                               if (!is_new) sets.join(static_cast<idx>(use->second), static_cast<idx>(i));
                           });
    primitives.first_vertex = {0};
    for (std::size_t i = 0; i < all.size(); ++i) // the smallest stands for a set and comes first
    {
        const auto root = static_cast<std::size_t>(sets.find(static_cast<idx>(i)));
        all[i].pool = root == i ? primitives.first_vertex.size() - 1 : all[root].pool;
        if (root != i) continue;
        vertices.take(all[i].vertices, "vertices");
        primitives.first_vertex.push_back(primitives.first_vertex.back() + all[i].vertices);
    }
}

/// Throws io_error, mesh_error (too_large).
inline gltf_primitives primitives_of(const gltf_source& source)
{
    gltf_primitives result;
    const gltf_json& meshes = root_of(source).items("meshes");
    for (std::size_t m = 0; m < meshes.size(); ++m)
        for (std::size_t p = 0; p < item_of(source, "meshes", m).items("primitives").size(); ++p)
            result.all.push_back(primitive_of(source, m, p));
    make_pools(source, result);

    using key = std::tuple<std::size_t, std::size_t, std::size_t>;
    std::map<key, std::vector<std::size_t>> known; // twins, by positions, indices and mode
    constexpr std::size_t limit = std::numeric_limits<idx>::max();
    gltf_allowance corners(source, 4); // strips have three an index, which may be a byte
    for (std::size_t i = 0; i < result.all.size(); ++i)
    {
        gltf_primitive& p = result.all[i];
        const std::size_t* const position = p.attribute("POSITION");
        const bool is_mapped = p.has_triangles() && position;
        if (is_mapped)
        {
            auto& same = known[key{*position, p.indices.value_or(SIZE_MAX), p.mode}];
            if (!same.empty() && (!source.apart || result.all[same.back()].mesh == p.mesh))
            {
                p.copy_of = same.back();
                p.layer = same.size() - 1;
            }
            else
            {
                if (!same.empty()) p.twin_of = same.front();
                p.layer = same.size();
                same.push_back(i);
            }
        }
        p.first = result.triangles;
        if (p.copy_of) continue;
        if (!p.twin_of) corners.take(p.drawn, "corners"); // twins are asked for
        if (!is_mapped) continue;
        p.count = p.mode == gltf_primitive::triangles ? p.drawn / 3 : p.drawn < 3 ? 0 : p.drawn - 2;
        if (p.mode != gltf_primitive::triangles && !p.twin_of) corners.take(2 * p.count, "corners");
        result.triangles += p.count;
        if (result.triangles > limit / 3) break;
    }
    if (result.triangles > limit / 3 || result.first_vertex.back() > limit)
        throw io_error(source.path, "more triangles or vertices than 32-bit numbers can name; split the model");
    return result;
}

/// The indices that a primitive draws. Throws io_error for those without a vertex.
inline std::vector<std::uint32_t> drawn_vertices(const gltf_source& source, const gltf_primitive& p)
{
    std::vector<std::uint32_t> drawn(p.drawn);
    if (!p.indices)
    {
        for (std::size_t i = 0; i < drawn.size(); ++i) drawn[i] = static_cast<std::uint32_t>(i);
        return drawn;
    }
    const gltf_accessor a = accessor_of(source, *p.indices);
    const std::string bytes = all_elements(source, a, "accessor " + std::to_string(*p.indices));
    for (std::size_t i = 0; i < drawn.size(); ++i)
    {
        drawn[i] = static_cast<std::uint32_t>(load_index(bytes, a.component, i));
        if (drawn[i] >= p.vertices)
            throw io_error(source.path, p.name + " names vertex " + std::to_string(drawn[i]) + " at index " +
                                            std::to_string(i) + ", but has " + std::to_string(p.vertices) +
                                            ", counted from 0");
    }
    return drawn;
}

/// The indices at the corners of triangle t of a primitive, oriented as it is drawn.
inline std::array<std::size_t, 3> corners_of(const gltf_primitive& p, std::size_t t)
{
    if (p.mode == gltf_primitive::triangles) return {3 * t, 3 * t + 1, 3 * t + 2};
    if (p.mode == gltf_primitive::fan) return {t + 1, t + 2, 0};
    return {t, t + 1 + t % 2, t + 2 - t % 2};
}

} // namespace taut::io::impl
