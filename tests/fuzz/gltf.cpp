// SPDX-License-Identifier: MIT
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <string>
#include <vector>

#include <sanitizer/allocator_interface.h>
#include <taut/gltf.hpp>
#include <taut/impl/files/gltf/gltf.hpp>

#include "../../src/gltf.cpp"
#include "../support/gltf_models.hpp"
#include "mutator.hpp"
#include "require.hpp"

namespace
{

using namespace taut;
using fuzz::dice;

/// Many more of what a document has a few of: small files that ask for much.
void multiply(test::gltf_json& d, dice& random)
{
    auto& primitives = d["meshes"][0]["primitives"];
    auto& list = random.one_in(4)   ? primitives
                 : random.one_in(3) ? d["meshes"]
                 : random.one_in(2) ? d["bufferViews"]
                                    : d["accessors"];
    const test::gltf_json item = list[random.below(list.size())];
    const std::size_t first = d["accessors"].size();
    for (std::size_t n = random.between(1, 40000 / (item.dump().size() + 40)); n > 0; --n)
    {
        list.push_back(item);
        // What is new is used, by primitives of its own or as attributes of one.
        if (d["accessors"].size() == first) continue;
        auto& p = primitives[0];
        const std::size_t number = d["accessors"].size() - 1;
        if (random.one_in(3))
            p["attributes"]["_A" + std::to_string(number)] = number;
        else
        {
            auto copy = p;
            if (random.one_in(2) || !copy.contains("indices"))
                copy["attributes"]["POSITION"] = number;
            else
                copy["indices"] = number;
            primitives.push_back(std::move(copy));
        }
    }
}

/// Nodes that are a scene, or none.
void add_nodes(test::gltf_json& d, dice& random)
{
    const auto numbers = [&](std::size_t count)
    {
        auto list = test::gltf_json::array();
        for (std::size_t n = random.one_in(20) ? random.below(20) : count; n > 0; --n)
            list.push_back(random.one_in(30) ? 1e308 : static_cast<double>(random.between(0, 8)) - 4);
        return list;
    };
    auto& nodes = d["nodes"];
    const std::size_t first = nodes.size();
    for (std::size_t n = random.between(1, 9); n > 0; --n)
    {
        auto node = test::gltf_json::object();
        if (random.one_in(2)) node["mesh"] = random.one_in(20) ? 5 : 0;
        if (random.one_in(4)) node["matrix"] = numbers(16);
        if (random.one_in(3)) node["scale"] = numbers(3);
        if (random.one_in(3)) node["rotation"] = numbers(4);
        if (random.one_in(3)) node["translation"] = numbers(3);
        if (random.one_in(9)) node["skin"] = 0;
        if (random.one_in(9))
            node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
                {random.pick({"TRANSLATION", "ROTATION", "SCALE"}), random.below(d["accessors"].size())}};
        if (random.one_in(2))
            node["children"] = {random.one_in(9) ? random.below(12) : nodes.size() + random.between(1, 2)};
        nodes.push_back(std::move(node));
    }
    if (random.one_in(2))
        d.erase("scenes");
    else
        d["scenes"][0]["nodes"].push_back(random.between(first, nodes.size()));
}

std::string generate(dice& random)
{
    const auto n = static_cast<std::uint32_t>(random.one_in(60) ? random.between(5, 40) : random.between(3, 4));
    auto builder = random.one_in(3)   ? test::textured_model(n)
                   : random.one_in(2) ? test::skinned_model(n)
                                      : test::morphing_model(n);
    auto& d = builder.document;
    // Members of accessors, bufferViews and primitives that are off, missing, or those of another one.
    for (std::size_t changes = random.between(0, 2); changes > 0; --changes)
    {
        auto& list = random.one_in(3)   ? d["meshes"][0]["primitives"]
                     : random.one_in(2) ? d["bufferViews"]
                                        : d["accessors"];
        auto& item = list[random.below(list.size())];
        auto member = std::next(item.begin(), static_cast<std::ptrdiff_t>(random.below(item.size())));
        if (random.one_in(5))
            item.erase(member);
        else if (member->is_number())
            *member = random.one_in(4) ? random.between(0, 1000000) : random.below(9);
        else if (member->is_object() && !member->empty())
            *member->begin() = random.below(7);
        else
            *member = random.pick({"SCALAR", "VEC2", "VEC3", "MAT2"});
    }
    if (random.one_in(2)) add_nodes(d, random);
    if (random.one_in(24)) multiply(d, random);
    if (random.one_in(20)) // an accessor that is nowhere
        d["accessors"].push_back({{"componentType", 5126}, {"count", random.between(1, 70000)}, {"type", "VEC3"}});
    for (std::size_t changes = random.one_in(2) ? 3 : 0; changes > 0; --changes)
        builder.bytes[random.below(builder.bytes.size())] = static_cast<char>(random.between(0, 255));
    return random.one_in(2) ? builder.glb() : builder.with_data_uri();
}

std::vector<std::array<vec2, 3>> corner_uv(const io::gltf_model& model)
{
    std::vector<std::array<vec2, 3>> uv(model.triangles.size());
    for (std::size_t t = 0; t < uv.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            uv[t][k] = {static_cast<double>(t % 4), static_cast<double>(model.triangles[t][k])};
    return uv;
}

/// Nodes draw meshes that are there, or are refused; each of them can have a mesh of its own, which is read and
/// written.
void require_scenes(const io::gltf_model& model)
{
    try
    {
        const auto draws = io::impl::drawn_meshes(model.source);
        for (const auto& draw : draws)
            fuzz::require(draw.mesh < model.source.document["meshes"].size() && draw.instances > 0, "a mesh is drawn");
        if (draws.size() > 20) return;
        auto source = model.source;
        io::impl::part_meshes(source, draws);
        const auto parted = io::impl::model_of(std::move(source));
        auto uv = corner_uv(parted);
        for (std::size_t t = 0; t < uv.size(); ++t) uv[t][0].x = 100.0 + static_cast<double>(t);
        auto [document, bytes] = io::impl::gltf_writer(parted, uv, 0, io::gltf_model::numbers::floats).write();
        auto again = io::impl::gltf_source_of(io::impl::join_glb(document.dump(), bytes, {}, "again"), "again");
        again.apart = true;
        const auto back = io::impl::model_of(std::move(again));
        fuzz::require(back.triangles == parted.triangles, "the same triangles apart");
        for (std::size_t t = 0; t < uv.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k)
                fuzz::require(back.texcoords[static_cast<std::size_t>(back.texcoord_cells[t][k])] ==
                                  io::gltf_model::rounded(uv[t][k]),
                              "the texture coordinates of each copy");
    }
    catch (const error&)
    {
    }
}

/// What is allocated for an input altogether, which says without a clock how much is done with it.
std::size_t allocated = 0;

void count_allocation(const volatile void*, std::size_t size)
{
    allocated += size;
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***)
{
    __sanitizer_install_malloc_and_free_hooks(count_allocation, [](const volatile void*) {});
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed)
{
    return taut::fuzz::mutate(data, size, most, seed, generate);
}

/// Whatever the bytes, they are a model that is written with other texture coordinates and read back, or an error of
/// the library; and what that takes is bounded by their number.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    allocated = 0;
    try
    {
        const auto model = io::impl::parse_gltf({reinterpret_cast<const char*>(data), size}, "/dev/null/a.gltf");
        const auto n = static_cast<idx>(model.points.size());
        for (const auto& t : model.triangles)
            for (const idx v : t) fuzz::require(v >= 0 && v < n, "triangles name points");
        const auto uv = corner_uv(model);
        require_scenes(model);
        auto [document, bytes] = io::impl::gltf_writer(model, uv, 0, io::gltf_model::numbers::floats).write();
        const auto again = io::impl::join_glb(document.dump(), bytes, {}, "again");
        try
        {
            const auto back = io::impl::parse_gltf(again, "again");
            fuzz::require(back.triangles == model.triangles, "the same triangles");
            for (std::size_t t = 0; t < uv.size(); ++t)
                for (std::size_t k = 0; k < 3; ++k)
                    fuzz::require(back.texcoords[static_cast<std::size_t>(back.texcoord_cells[t][k])] ==
                                      io::gltf_model::rounded(uv[t][k]),
                                  "the texture coordinates that were written");
        }
        catch (const error& e)
        {
            std::fprintf(stderr, "%s\n%s\n", e.what(), document.dump().c_str());
            fuzz::require(false, "what is written can be read");
        }
    }
    catch (const error&)
    {
    }
    fuzz::require(allocated <= (std::size_t(256) << 20) + 4096 * size, "memory is bounded by the bytes of the file");
    return 0;
}
