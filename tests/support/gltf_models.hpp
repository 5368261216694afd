// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/files/gltf/arrays.hpp>
#include <taut/impl/files/gltf/container.hpp>

/// glTF files made for tests.
namespace taut::test
{

using gltf_json = io::impl::gltf_json;

/// How a model keeps its data.
enum class gltf_form
{
    glb,
    data_uri,
    files ///< model.gltf and model data.bin
};

/// Makes a document piece by piece.
class gltf_builder
{
public:
    gltf_json document = {{"asset", {{"version", "2.0"}, {"generator", "a test"}}},
                          {"scene", 0},
                          {"scenes", gltf_json::array({{{"nodes", {0}}}})},
                          {"nodes", gltf_json::array({{{"mesh", 0}}})}};
    std::string bytes;

    std::size_t view(const std::string& content, gltf_json members = gltf_json::object())
    {
        bytes.append((4 - bytes.size() % 4) % 4, '\0');
        gltf_json v = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", content.size()}};
        v.update(members);
        bytes += content;
        document["bufferViews"].push_back(v);
        return document["bufferViews"].size() - 1;
    }

    std::size_t accessor(std::size_t view, unsigned component, const char* type, std::size_t count,
                         gltf_json members = gltf_json::object())
    {
        gltf_json a = {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}};
        a.update(members);
        document["accessors"].push_back(a);
        return document["accessors"].size() - 1;
    }

    /// An accessor with a view of its own.
    template <class T>
    std::size_t array(const std::vector<T>& numbers, unsigned component, const char* type,
                      gltf_json members = gltf_json::object(), gltf_json view_members = gltf_json::object())
    {
        const std::size_t size = io::impl::element_size(type, static_cast<io::impl::gltf_component>(component));
        const std::size_t v = view(io::impl::bytes_of<T>(numbers), std::move(view_members));
        return accessor(v, component, type, numbers.size() * sizeof(T) / size, std::move(members));
    }

    std::string gltf(const std::string& uri) const
    {
        gltf_json d = document;
        d["buffers"] = gltf_json::array({{{"byteLength", bytes.size()}, {"name", "all"}}});
        if (!uri.empty()) d["buffers"][0]["uri"] = uri;
        return d.dump();
    }

    std::string glb() const { return io::impl::join_glb(gltf(""), bytes, {}, "a test"); }
    std::string with_data_uri() const
    {
        return gltf("data:application/octet-stream;base64," + io::impl::to_base64(bytes));
    }
};

/// A torus of n by n quads, each two triangles, whose vertices are all shared: closed.
struct torus_arrays
{
    std::vector<float> positions, normals, texcoords;
    std::vector<std::uint32_t> indices;
    std::size_t vertices;

    explicit torus_arrays(std::uint32_t n) : vertices(n * n)
    {
        const double turn = 2 * std::acos(-1.0) / n;
        for (std::uint32_t i = 0; i < n; ++i)
            for (std::uint32_t j = 0; j < n; ++j)
            {
                const double a = i * turn, b = j * turn, r = 3 + std::cos(b);
                const auto add = [](std::vector<float>& to, std::initializer_list<double> xs)
                {
                    for (const double x : xs) to.push_back(static_cast<float>(x));
                };
                add(positions, {r * std::cos(a), r * std::sin(a), std::sin(b)});
                add(normals, {std::cos(b) * std::cos(a), std::cos(b) * std::sin(a), std::sin(b)});
                add(texcoords, {i / static_cast<double>(n), j / static_cast<double>(n)});
                const auto v = [n](std::uint32_t k, std::uint32_t l) { return k % n * n + l % n; };
                for (const std::uint32_t w :
                     {v(i, j), v(i + 1, j), v(i + 1, j + 1), v(i, j), v(i + 1, j + 1), v(i, j + 1)})
                    indices.push_back(w);
            }
    }

    static gltf_json bounds(const std::vector<float>& points)
    {
        gltf_json low = gltf_json::array(), high = gltf_json::array();
        for (std::size_t k = 0; k < 3; ++k)
        {
            float least = points[k], most = least;
            for (std::size_t i = k; i < points.size(); i += 3)
            {
                least = std::min(least, points[i]);
                most = std::max(most, points[i]);
            }
            low.push_back(least);
            high.push_back(most);
        }
        return {{"min", low}, {"max", high}};
    }
    gltf_json bounds() const { return bounds(positions); }
};

/// Two materials, each with half of the triangles, an image as a bufferView, a camera, extras everywhere, and
/// extensions that nobody knows.
inline gltf_builder textured_model(std::uint32_t n = 8)
{
    const torus_arrays torus(n);
    gltf_builder b;
    const gltf_json vertex = {{"target", 34962}}, index = {{"target", 34963}};
    const std::size_t position = b.array(torus.positions, 5126, "VEC3", torus.bounds(), vertex),
                      normal =
                          b.array(torus.normals, 5126, "VEC3", {{"name", "directions"}, {"extras", {1, 2}}}, vertex),
                      coords = b.array(torus.texcoords, 5126, "VEC2", {{"extras", {{"of", "old"}}}}, vertex);
    std::vector<std::uint8_t> colours, ids;
    for (std::size_t v = 0; v < torus.vertices; ++v)
    {
        for (const std::size_t c : {v % 251, v % 13, std::size_t(7), std::size_t(255)})
            colours.push_back(static_cast<std::uint8_t>(c));
        for (const std::size_t c : {v % 250, std::size_t(1), v % 3, std::size_t(0)}) // 3 and a gap
            ids.push_back(static_cast<std::uint8_t>(c));
    }
    const std::size_t colour = b.array(colours, 5121, "VEC4", {{"normalized", true}}, vertex);
    const std::size_t id =
        b.accessor(b.view(io::impl::bytes_of<std::uint8_t>(ids), {{"byteStride", 4}, {"target", 34962}}), 5121, "VEC3",
                   torus.vertices);
    const std::string png = // one pixel
        *io::impl::from_base64(
            "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mP436AAAAQhAaBzQuE8AAAAAElFTkSuQmCC");
    b.document["images"] = gltf_json::array({{{"bufferView", b.view(png)}, {"mimeType", "image/png"}}});
    b.document["textures"] = gltf_json::array({{{"source", 0}, {"extras", nullptr}}});
    const std::size_t half = torus.indices.size() / 6 * 3;
    gltf_json primitives = gltf_json::array();
    for (const std::size_t part : {std::size_t(0), std::size_t(1)})
    {
        const auto first = torus.indices.begin();
        const std::vector<std::uint16_t> indices(part == 0 ? first : first + static_cast<std::ptrdiff_t>(half),
                                                 part == 0 ? first + static_cast<std::ptrdiff_t>(half)
                                                           : torus.indices.end());
        b.document["materials"].push_back(
            {{"name", "material " + std::to_string(part)},
             {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"roughnessFactor", 0.30000001192092896}}},
             {"extensions", {{"TEST_unknown", {{"depth", 12345678901234}, {"bufferView", 1}}}}}});
        primitives.push_back(
            {{"attributes",
              {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", coords}, {"COLOR_0", colour}, {"_ID", id}}},
             {"indices", b.array(indices, 5123, "SCALAR", gltf_json::object(), index)},
             {"material", part},
             {"extras", {{"part", part}}}});
    }
    b.document["meshes"] =
        gltf_json::array({{{"primitives", primitives}, {"name", "ring"}, {"extras", {{"bufferView", 99}}}}});
    b.document["cameras"] = gltf_json::array(
        {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.01}}}, {"extras", "a camera"}}});
    b.document["nodes"].push_back({{"camera", 0}, {"extensions", {{"TEST_unknown", gltf_json::object()}}}});
    b.document["extensionsUsed"] = {"TEST_unknown"};
    b.document["extras"] = {{"author", "nobody"}, {"none", nullptr}};
    return b;
}

/// Joints and weights, a skin and an animation; positions, normals and texture coordinates interleaved in one view.
inline gltf_builder skinned_model(std::uint32_t n = 8)
{
    const torus_arrays torus(n);
    gltf_builder b;
    std::string records;
    std::vector<std::uint8_t> joints;
    std::vector<float> weights;
    for (std::size_t v = 0; v < torus.vertices; ++v)
    {
        std::vector<float> record;
        for (std::size_t k = 0; k < 3; ++k) record.push_back(torus.positions[3 * v + k]);
        for (std::size_t k = 0; k < 3; ++k) record.push_back(torus.normals[3 * v + k]);
        for (std::size_t k = 0; k < 2; ++k) record.push_back(torus.texcoords[2 * v + k]);
        records += io::impl::bytes_of<float>(record);
        joints.insert(joints.end(), {0, 1, 0, 0});
        const float w = static_cast<float>(v % n) / static_cast<float>(n);
        for (const float x : {1 - w, w, 0.0f, 0.0f}) weights.push_back(x);
    }
    const std::size_t interleaved = b.view(records, {{"byteStride", 32}, {"target", 34962}});
    const std::size_t position = b.accessor(interleaved, 5126, "VEC3", torus.vertices, torus.bounds()),
                      normal = b.accessor(interleaved, 5126, "VEC3", torus.vertices, {{"byteOffset", 12}}),
                      coords = b.accessor(interleaved, 5126, "VEC2", torus.vertices, {{"byteOffset", 24}}),
                      joint = b.array(joints, 5121, "VEC4"), weight = b.array(weights, 5126, "VEC4"),
                      indices = b.array(torus.indices, 5125, "SCALAR"),
                      times = b.array(std::vector<float>{0, 1, 2.5}, 5126, "SCALAR", {{"min", {0}}, {"max", {2.5}}}),
                      turns = b.array(std::vector<float>{0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 1}, 5126, "VEC4");
    std::vector<float> matrices(32, 0.0f);
    for (const std::size_t k : {0u, 5u, 10u, 15u, 16u, 21u, 26u, 31u}) matrices[k] = 1;
    const std::size_t inverse = b.array(matrices, 5126, "MAT4");
    b.document["nodes"] = gltf_json::array({{{"mesh", 0}, {"skin", 0}}, {{"children", {2}}}, {{"name", "tip"}}});
    b.document["scenes"] = gltf_json::array({{{"nodes", {0, 1}}}});
    b.document["skins"] = gltf_json::array({{{"joints", {1, 2}}, {"inverseBindMatrices", inverse}}});
    b.document["animations"] = gltf_json::array(
        {{{"channels", gltf_json::array({{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}}})},
          {"samplers", gltf_json::array({{{"input", times}, {"output", turns}, {"interpolation", "STEP"}}})}}});
    b.document["meshes"] = gltf_json::array({{{"primitives", gltf_json::array({{{"attributes",
                                                                                 {{"POSITION", position},
                                                                                  {"NORMAL", normal},
                                                                                  {"TEXCOORD_0", coords},
                                                                                  {"JOINTS_0", joint},
                                                                                  {"WEIGHTS_0", weight}}},
                                                                                {"indices", indices}}})}}});
    return b;
}

/// Two targets of morphing, one dense, one sparse on zeros; sparse positions; indices of 8 bits; no texture
/// coordinates.
inline gltf_builder morphing_model(std::uint32_t n = 8)
{
    torus_arrays torus(n);
    gltf_builder b;
    const gltf_json bounds = torus.bounds();
    const std::vector<float> moved(torus.positions.begin() + 6, torus.positions.begin() + 9);
    for (std::size_t k = 6; k < 9; ++k) torus.positions[k] = 0; // vertex 2 is sparse
    const auto sparse = [&](const std::vector<std::uint8_t>& indices, const std::vector<float>& values)
    {
        return gltf_json{
            {"count", indices.size()},
            {"indices", {{"bufferView", b.view(io::impl::bytes_of<std::uint8_t>(indices))}, {"componentType", 5121}}},
            {"values", {{"bufferView", b.view(io::impl::bytes_of<float>(values))}}}};
    };
    gltf_json members = bounds;
    members["sparse"] = sparse({2}, moved);
    const std::size_t position = b.array(torus.positions, 5126, "VEC3", members),
                      dense = b.array(torus.normals, 5126, "VEC3", torus_arrays::bounds(torus.normals));
    const gltf_json few = sparse({0, 3, 9}, {0.5f, 0, 0, 0, 0.5f, 0, 0, 0, 0.5f});
    b.document["accessors"].push_back({{"componentType", 5126},
                                       {"count", torus.vertices},
                                       {"type", "VEC3"},
                                       {"min", {0, 0, 0}},
                                       {"max", {0.5, 0.5, 0.5}},
                                       {"sparse", few}});
    const std::size_t thin = b.document["accessors"].size() - 1;
    const std::vector<std::uint8_t> narrow(torus.indices.begin(), torus.indices.end());
    const std::size_t indices = b.array(narrow, 5121, "SCALAR");
    b.document["meshes"] = gltf_json::array(
        {{{"weights", {0.25, 0.5}},
          {"primitives",
           gltf_json::array({{{"attributes", {{"POSITION", position}}},
                              {"targets", gltf_json::array({{{"POSITION", dense}}, {{"POSITION", thin}}})},
                              {"indices", indices}}})}}});
    return b;
}

} // namespace taut::test
