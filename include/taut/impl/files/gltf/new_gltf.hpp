// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include <taut/errors.hpp>
#include <taut/impl/files/gltf/arrays.hpp>
#include <taut/impl/files/gltf/placement.hpp>
#include <taut/types.hpp>

namespace taut::io::impl
{

/// The normals of vertices: those of their triangles weighted by area, of length 1; z where there is none.
inline std::vector<vec3> area_normals(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles)
{
    std::vector<vec3> normals(points.size(), vec3(0.0));
    const auto u = [](idx v) { return static_cast<std::size_t>(v); };
    for (const auto& t : triangles)
    {
        const vec3 n = glm::cross(points[u(t[1])] - points[u(t[0])], points[u(t[2])] - points[u(t[0])]);
        for (const idx v : t) normals[u(v)] += n;
    }
    for (vec3& n : normals)
    {
        const double largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
        n = largest > 0 && std::isfinite(largest) ? glm::normalize(n / largest) : vec3(0.0, 0.0, 1.0);
    }
    return normals;
}

/// A document of one mesh without texture coordinates, and of one node.
/// triangles: whose vertices are all there and finite
inline gltf_source new_gltf_source(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles,
                                   const gltf_placement& placement)
{
    gltf_source source{{}, gltf_json::object()};
    gltf_json &document = source.document, views = gltf_json::array(), accessors = gltf_json::array();
    std::string bytes;
    const auto add =
        [&](const std::string& elements, gltf_component component, const char* type, std::size_t count, unsigned target)
    {
        bytes.append((4 - bytes.size() % 4) % 4, '\0');
        views.push_back(
            {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", elements.size()}, {"target", target}});
        bytes += elements;
        accessors.push_back(
            {{"bufferView", accessors.size()}, {"componentType", component}, {"count", count}, {"type", type}});
    };
    const auto numbers = [&](std::span<const vec3> list)
    {
        std::vector<float> all;
        all.reserve(3 * list.size());
        for (const vec3& p : list)
            for (int k = 0; k < 3; ++k)
            {
                const auto x = static_cast<float>(taut::impl::in_single(p[k]));
                all.push_back(std::isfinite(x) ? x : 0); // nothing draws what is not finite
            }
        return all;
    };
    std::vector<vec3> placed;
    placed.reserve(points.size());
    for (const vec3& p : points) placed.push_back(placement.of_mesh(p));
    const auto positions = numbers(placed);
    add(bytes_of<float>(positions), gltf_f32, "VEC3", points.size(), gltf_vertex_target);
    std::array<float, 3> low, high;
    for (std::size_t k = 0; k < 3; ++k)
    {
        low[k] = high[k] = positions[k];
        for (std::size_t i = k; i < positions.size(); i += 3)
        {
            low[k] = std::min(low[k], positions[i]);
            high[k] = std::max(high[k], positions[i]);
        }
    }
    accessors[0]["min"] = low;
    accessors[0]["max"] = high;
    add(bytes_of<float>(numbers(area_normals(placed, triangles))), gltf_f32, "VEC3", points.size(), gltf_vertex_target);
    std::vector<std::uint32_t> drawn, sources(points.size());
    for (std::size_t v = 0; v < sources.size(); ++v) sources[v] = static_cast<std::uint32_t>(v);
    for (const auto& t : triangles) drawn.insert(drawn.end(), t.begin(), t.end());
    add(bytes_of<std::uint32_t>(sources), gltf_u16, "VEC2", points.size(), gltf_vertex_target);
    const gltf_component type = type_for(points.size(), gltf_u16);
    add(index_bytes(drawn, type), type, "SCALAR", drawn.size(), gltf_index_target);

    document["asset"] = {{"version", "2.0"}, {"generator", "taut"}};
    document["scene"] = 0;
    document["scenes"] = gltf_json::array({{{"nodes", {0}}}});
    gltf_json node = {{"mesh", 0}};
    const auto three = [](const vec3& x) { return std::array<double, 3>{x.x, x.y, x.z}; };
    if (placement.translation != vec3(0.0)) node["translation"] = three(placement.translation);
    if (placement.scale != 1) node["scale"] = three(vec3(placement.scale));
    document["nodes"] = gltf_json::array({std::move(node)});
    document["meshes"] = gltf_json::array(
        {{{"primitives", gltf_json::array({{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"_SOURCE_VERTEX", 2}}},
                                            {"indices", 3}}})}}});
    document["accessors"] = std::move(accessors);
    document["bufferViews"] = std::move(views);
    document["buffers"] = gltf_json::array({{{"byteLength", bytes.size()}}});
    source.buffers.push_back(std::move(bytes));
    return source;
}

} // namespace taut::io::impl
