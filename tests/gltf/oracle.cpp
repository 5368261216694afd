// SPDX-License-Identifier: MIT
// tinygltf reads what was written for generated models, and finds at each corner what it finds in the input, but for
// the new texture coordinates. Sparse elements, which it does not apply, are left to the tests of the library.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include <tiny_gltf.h>

#include <support/gltf_models.hpp>
#include <taut/gltf.hpp>
#include <taut/impl/files/file/read_file.hpp>
#include <taut/impl/files/gltf/gltf.hpp>

using namespace taut;

namespace
{

int failures = 0;

void require(bool holds, const std::string& what)
{
    if (holds) return;
    std::cout << "broken: " << what << '\n';
    ++failures;
}

tinygltf::Model load(const std::string& bytes, const std::string& what)
{
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader([](auto...) { return true; }, nullptr); // their bytes are compared
    tinygltf::Model model;
    std::string error, warning;
    const bool read =
        loader.LoadBinaryFromMemory(&model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()),
                                    static_cast<unsigned>(bytes.size()));
    require(read && error.empty(), what + ": " + error);
    return model;
}

std::string element(const tinygltf::Model& m, int accessor, std::size_t i)
{
    const auto& a = m.accessors[static_cast<std::size_t>(accessor)];
    if (a.bufferView < 0) return {};
    const auto& v = m.bufferViews[static_cast<std::size_t>(a.bufferView)];
    const auto size =
        static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(a.componentType)) *
                                 tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(a.type)));
    const auto stride = static_cast<std::size_t>(a.ByteStride(v));
    const auto* const at =
        m.buffers[static_cast<std::size_t>(v.buffer)].data.data() + v.byteOffset + a.byteOffset + i * stride;
    return std::string(reinterpret_cast<const char*>(at), size);
}

std::vector<std::size_t> drawn(const tinygltf::Model& m, const tinygltf::Primitive& p)
{
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < m.accessors[static_cast<std::size_t>(p.indices)].count; ++i)
    {
        std::uint32_t v = 0;
        const std::string bytes = element(m, p.indices, i);
        std::memcpy(&v, bytes.data(), bytes.size());
        result.push_back(v);
    }
    return result;
}

void compare(const test::gltf_builder& builder, std::size_t chart, const std::string& name)
{
    const auto model = io::impl::parse_gltf(builder.glb());
    std::vector<std::array<vec2, 3>> uv;
    for (std::size_t t = 0; t < model.triangles.size(); ++t)
    {
        std::array<vec2, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = {0.125 * static_cast<double>(t / chart % 8),
                          0.001 * static_cast<double>(model.triangles[t][k])};
        uv.push_back(corners);
    }
    const auto written =
        std::filesystem::temp_directory_path() / ("taut-tinygltf-" + std::to_string(std::random_device{}()) + ".glb");
    model.write(written, uv);
    const auto before = load(builder.glb(), name), after = load(io::impl::read_file(written), name);
    std::filesystem::remove(written);
    require(before.materials == after.materials && before.nodes == after.nodes && before.skins == after.skins &&
                before.animations == after.animations && before.cameras == after.cameras &&
                before.textures == after.textures,
            name + ": materials, nodes, skins, animations, cameras, textures");
    std::size_t t = 0;
    for (std::size_t i = 0; i < before.meshes[0].primitives.size(); ++i)
    {
        const auto &p = before.meshes[0].primitives[i], &q = after.meshes[0].primitives[i];
        const auto old = drawn(before, p), now = drawn(after, q);
        require(old.size() == now.size(), name + ": as many indices");
        for (std::size_t c = 0; c < old.size(); ++c)
        {
            for (const auto& [key, accessor] : p.attributes)
                if (key != "TEXCOORD_0")
                    require(element(before, accessor, old[c]) == element(after, q.attributes.at(key), now[c]),
                            name + ": " + key);
            for (std::size_t k = 0; k < p.targets.size(); ++k)
                for (const auto& [key, accessor] : p.targets[k])
                    require(element(before, accessor, old[c]) == element(after, q.targets[k].at(key), now[c]),
                            name + ": target of " + key);
            std::array<float, 2> x;
            std::memcpy(x.data(), element(after, q.attributes.at("TEXCOORD_0"), now[c]).data(), sizeof x);
            const vec2 wanted = uv[t + c / 3][c % 3];
            require(x[0] == static_cast<float>(wanted.x) && x[1] == static_cast<float>(wanted.y),
                    name + ": texture coordinates");
        }
        t += old.size() / 3;
    }
    require(t == model.triangles.size(), name + ": all triangles");
}

} // namespace

int main()
{
    for (const std::size_t chart : {1u, 5u, 100000u})
        for (const std::uint32_t n : {7u, 15u})
        {
            compare(test::textured_model(n), chart, "textured");
            compare(test::skinned_model(n), chart, "skinned");
            compare(test::morphing_model(n), chart, "morphing");
        }
    std::cout << (failures == 0 ? "tinygltf agrees" : "tinygltf does not agree") << '\n';
    return failures == 0 ? 0 : 1;
}
