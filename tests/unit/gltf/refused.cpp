// SPDX-License-Identifier: MIT
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <support/gltf_models.hpp>
#include <support/temporary_folder.hpp>
#include <taut/errors.hpp>
#include <taut/gltf.hpp>
#include <taut/impl/files/gltf/gltf.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using document = io::impl::gltf_json;

document document_of(const std::string& text)
{
    return document::parse(text);
}

/// Reads and writes whatever the bytes are: that works, or throws an error of ours.
void feed_gltf(const std::string& bytes)
{
    try
    {
        const auto model = io::impl::parse_gltf(bytes);
        CHECK(!model.triangles.empty());
        std::vector<std::array<vec2, 3>> uv(model.triangles.size());
        for (std::size_t t = 0; t < uv.size(); ++t) uv[t] = {vec2(0, t), vec2(1, t), vec2(0, t % 3)};
        CHECK(!io::impl::gltf_files("out.glb", model, uv).empty());
    }
    catch (const error& e)
    {
        CHECK(std::string(e.what()).size() > 0);
    }
}

} // namespace

TEST_CASE("gltf: what cannot be read is refused by name, with the reason")
{
    // A model after a change, as JSON with its data in it.
    const auto refuses = [](const std::function<void(document&)>& change, const char* what)
    {
        auto builder = test::morphing_model(5);
        change(builder.document);
        CHECK_THROWS_WITH_AS(io::impl::parse_gltf(builder.with_data_uri(), "x.gltf"), doctest::Contains(what), error);
    };
    const auto primitive = [](document& d) -> document& { return d["meshes"][0]["primitives"][0]; };
    refuses([](document& d) { d["asset"]["version"] = "1.0"; }, "x.gltf: glTF 1.0 is not read; convert it to glTF 2.0");
    refuses([](document& d) { d.erase("asset"); }, "the document has no asset");
    refuses([](document& d) { d["meshes"] = 3; }, "the document has meshes that are no array");
    refuses([](document& d) { d["meshes"] = document::array({7}); }, "meshes 0 is no JSON object");
    refuses([](document& d) { d["meshes"] = document::array(); }, "there are no triangles");
    refuses([&](document& d) { primitive(d)["indices"] = 70; }, "accessors 70 is named, but there are 4");
    refuses([&](document& d) { primitive(d)["indices"] = 1.5; }, "has a indices that is no whole number");
    refuses([&](document& d) { primitive(d)["indices"] = -1; }, "no whole number");
    refuses([&](document& d) { primitive(d)["indices"] = 1; },
            "primitive 0 of mesh 0 has indices that are no unsigned");
    refuses([&](document& d) { primitive(d)["attributes"]["NORMAL"] = 3; }, "attributes of different counts: NORMAL");
    refuses([&](document& d) { primitive(d)["attributes"] = "x"; }, "is no JSON object");
    refuses([&](document& d) { primitive(d)["extensions"]["KHR_draco_mesh_compression"] = document::object(); },
            "compressed with KHR_draco_mesh_compression; decompress the file");
    refuses([](document& d) { d["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["mode"] = 1; },
            "bufferViews 0 is compressed with EXT_meshopt_compression; decompress the file");
    refuses([](document& d) { d["accessors"][0]["componentType"] = 5130; }, "accessors 0 has numbers of an unknown");
    refuses([](document& d) { d["accessors"][0]["type"] = "VEC9"; }, "accessors 0 is of an unknown type");
    refuses([](document& d) { d["accessors"][0]["count"] = 26; }, "accessors 0 goes beyond the end of bufferView");
    refuses([](document& d) { d["accessors"][0]["byteOffset"] = 1e15; }, "no whole number");
    refuses([](document& d) { d["accessors"][0]["byteOffset"] = 9007199254740992; },
            "goes beyond the end of bufferView");
    refuses([](document& d) { d["accessors"][2]["count"] = 9007199254740992; }, "attributes of different counts");
    refuses(
        [&](document& d)
        {
            d["accessors"][2]["count"] = 9007199254740992;
            primitive(d).erase("targets");
            primitive(d)["attributes"] = {{"POSITION", 2}};
        },
        "more vertices than the bytes of its buffers can stand for");
    refuses([](document& d) { d["accessors"][2]["count"] = 2; }, "accessors 2.sparse has more elements than its");
    refuses([](document& d) { d["accessors"][2]["sparse"]["count"] = 1 << 30; },
            "accessors 2.sparse.indices goes beyond");
    refuses([](document& d) { d["accessors"][0]["sparse"]["indices"]["byteOffset"] = 1; }, "goes beyond");
    refuses([](document& d) { d["bufferViews"][2]["byteLength"] = 1 << 30; }, "bufferViews 2 goes beyond the end");
    refuses([](document& d) { d["bufferViews"][2]["buffer"] = 1; }, "bufferViews 2 names buffer 1 of 1");
    refuses([](document& d) { d["bufferViews"][2]["byteStride"] = 4; }, "on top of each other");
    refuses([](document& d) { d["accessors"][3].erase("bufferView"); }, "has indices without a bufferView");
    refuses([](document& d) { d["accessors"][0]["type"] = "SCALAR"; }, "POSITION that is no VEC3");
    refuses(
        [&](document& d) {
            primitive(d)["attributes"] = {{"POSITION", 0}, {"TEXCOORD_0", 1}};
        },
        "TEXCOORD_0 that is no VEC2");
    CHECK_THROWS_WITH_AS(io::impl::parse_gltf("{\"a\": }", "x.gltf"),
                         doctest::Contains("x.gltf: no JSON of glTF: parse error"), io::io_error);
    CHECK_THROWS_WITH_AS(io::impl::parse_gltf(std::string(100000, '['), "x.gltf"), doctest::Contains("nested too deep"),
                         io::io_error);
    auto quoted = test::morphing_model(4);
    quoted.document["extras"] = {std::string(300, '['), "\\\"" + std::string(300, '{')};
    CHECK(!io::impl::parse_gltf(quoted.glb()).triangles.empty());
    CHECK_THROWS_AS(io::impl::parse_gltf(""), io::io_error);
}

TEST_CASE("gltf: an index that names no vertex is refused with its place")
{
    auto builder = test::morphing_model(5);
    builder.bytes[builder.document["bufferViews"].back()["byteOffset"].get<std::size_t>() + 7] = 77;
    CHECK_THROWS_WITH_AS(io::impl::parse_gltf(builder.glb(), "x.glb"),
                         "x.glb: primitive 0 of mesh 0 names vertex 77 at index 7, but has 25, counted from 0",
                         io::io_error);
}

TEST_CASE("gltf: buffers that are missing, too short, far away or no base64 are refused")
{
    const auto builder = test::textured_model(4);
    const test::temporary_folder folder;
    const auto refuses = [&](const std::string& uri, const char* what)
    {
        folder.write(folder / "x.gltf", builder.gltf(uri));
        CHECK_THROWS_WITH_AS(io::read_gltf(folder / "x.gltf"), doctest::Contains(what), io::io_error);
    };
    refuses("", "buffers 0 has no uri");
    refuses("a.bin", "a.bin, which is no file");
    refuses("a%20b.bin", "a b.bin, which is no file");
    refuses(".", "which is no file");
    refuses("https://example.org/a.bin", "fetch it to a file beside the document");
    refuses("data:,abc", "a data URI that is no base64");
    refuses("data:application/octet-stream;base64,AA*A", "a data URI that is no base64");
    refuses("data:application/octet-stream;base64,AAAA", "buffers 0 has 3 bytes, not the ");
    folder.write(folder / "a.bin", builder.bytes.substr(1));
    refuses("a.bin", "that the document says");
}

TEST_CASE("gltf: no buffer is read from outside of the folder of the document")
{
    namespace fs = std::filesystem;
    const auto builder = test::textured_model(4);
    const test::temporary_folder folder;
    fs::create_directories(folder / "model/sub");
    for (const char* const name : {"secret.bin", "model/t.bin", "model/sub/t.bin"})
        folder.write(folder / name, builder.bytes);
    const bool links = test::make_link("../secret.bin", folder / "model/link.bin") &&
                       test::make_link("..", folder / "model/up") &&
                       test::make_link("t.bin", folder / "model/inside.bin");
    const auto document = folder / "model/x.gltf";
    const auto refuses = [&](const std::string& uri, const char* what)
    {
        folder.write(document, builder.gltf(uri));
        CHECK_THROWS_WITH_AS(io::read_gltf(document), doctest::Contains(what), io::io_error);
        CHECK(io::impl::gltf_companions(document).empty());
    };
    const std::string secret = '/' + fs::absolute(folder / "secret.bin").relative_path().generic_string();
    for (const std::string& uri :
         {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"), std::string("sub/../../secret.bin"),
          std::string("sub/..%2Ft.bin"), secret, "%2F" + secret.substr(1), std::string("//secret.bin")})
        refuses(uri, "outside of the folder of the document; put the file itself beside the document");
    for (const char* const uri : {"link.bin", "up/secret.bin"})
        if (links) refuses(uri, "a link out of the folder");
    for (const char* const uri : {"..\\secret.bin", "..%5csecret.bin", "t.bin%00"}) refuses(uri, "no path of a URI");
    refuses("file:///etc/passwd", "fetch it");
    for (const char* const uri : {"t.bin", "sub/t.bin", "./t.bin", links ? "inside.bin" : "t.bin"})
    {
        folder.write(document, builder.gltf(uri));
        CHECK(io::read_gltf(document).source.files.size() == 1);
        CHECK(io::impl::gltf_companions(document).size() == 1);
    }
    // Buffers that no bufferView names are not read; nor is a file twice.
    auto d = document_of(builder.gltf("t.bin"));
    d["buffers"].push_back({{"uri", "../secret.bin"}, {"byteLength", 8}});
    folder.write(document, d.dump());
    const auto model = io::read_gltf(document);
    CHECK(model.source.files.size() == 1);
    const std::vector<std::array<vec2, 3>> uv(model.triangles.size());
    model.write(folder / "out.gltf", uv);
    CHECK(io::read_gltf(folder / "out.gltf").source.buffers.size() == 1);
    if (!links) return;
    d["buffers"][1]["uri"] = "inside.bin";
    d["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 8}});
    folder.write(document, d.dump());
    CHECK_THROWS_WITH_AS(io::read_gltf(document), doctest::Contains("join the two"), io::io_error);
}

TEST_CASE("gltf: what a file asks for is bounded by its bytes")
{
    const test::torus_arrays torus(40);
    const auto refuses = [](test::gltf_builder& b, const char* what)
    { CHECK_THROWS_WITH_AS(io::impl::parse_gltf(b.glb(), "x.glb"), doctest::Contains(what), io::io_error); };
    const auto primitive = [](std::size_t positions, std::size_t indices) {
        return document{{"attributes", {{"POSITION", positions}}}, {"indices", indices}};
    };
    const auto base = [&]
    {
        test::gltf_builder b;
        b.array(torus.positions, 5126, "VEC3", torus.bounds());
        b.array(torus.indices, 5125, "SCALAR");
        return b;
    };
    SUBCASE("elements that are nowhere")
    {
        test::gltf_builder b = base();
        b.document["meshes"] = document::array({{{"primitives", document::array()}}});
        for (std::size_t i = 0; i < 100; ++i)
        {
            b.document["accessors"].push_back({{"componentType", 5126}, {"count", 65535}, {"type", "VEC3"}});
            b.document["meshes"][0]["primitives"].push_back(primitive(2 + i, 1));
        }
        refuses(b, "more vertices than the bytes");
    }
    SUBCASE("accessors of the same positions")
    {
        test::gltf_builder b = base();
        b.document["meshes"] = document::array({{{"primitives", document::array()}}});
        for (std::size_t i = 0; i < 1000; ++i)
        {
            b.document["accessors"].push_back(document(b.document["accessors"][0]));
            b.document["meshes"][0]["primitives"].push_back(primitive(2 + i, 1));
        }
        refuses(b, "than the bytes");
    }
    SUBCASE("accessors of the same indices, and texture coordinates")
    {
        for (const char* const list : {"indices", "TEXCOORD_0", "points"})
        {
            test::gltf_builder b = base();
            b.array(std::vector<float>(2 * torus.vertices), 5126, "VEC2");
            b.array(std::vector<std::uint8_t>{0, 1, 2}, 5121, "SCALAR");
            b.document["meshes"] = document::array({{{"primitives", document::array()}}});
            const std::string name = list;
            for (std::size_t i = 0; i < 1000; ++i)
            {
                b.document["accessors"].push_back(document(b.document["accessors"][name == "TEXCOORD_0" ? 2
                                                                                   : name == "points"   ? 1
                                                                                                        : 1]));
                auto p = primitive(0, name == "TEXCOORD_0" ? 3 : 4 + i);
                if (name == "TEXCOORD_0") b.document["accessors"].push_back(document(b.document["accessors"][3]));
                if (name == "TEXCOORD_0") p["indices"] = 5 + 2 * i;
                if (name == "TEXCOORD_0") p["attributes"][name] = 4 + 2 * i;
                if (name == "points") p["mode"] = 0;
                b.document["meshes"][0]["primitives"].push_back(p);
            }
            refuses(b, "than the bytes");
        }
    }
    SUBCASE("attributes that are split")
    {
        test::gltf_builder b = base();
        auto p = primitive(0, 1);
        for (std::size_t i = 0; i < 500; ++i)
        {
            b.document["accessors"].push_back(document(b.document["accessors"][0]));
            p["attributes"]["_A" + std::to_string(i)] = 2 + i;
        }
        b.document["meshes"] = document::array({{{"primitives", document::array({p})}}});
        const auto model = io::impl::parse_gltf(b.glb());
        std::vector<std::array<vec2, 3>> uv(model.triangles.size());
        io::impl::gltf_files("out.glb", model, uv);
        for (std::size_t t = 0; t < uv.size(); ++t) uv[t][0].x = static_cast<double>(t);
        CHECK_THROWS_WITH_AS(io::impl::gltf_files("out.glb", model, uv), doctest::Contains("more new bytes than"),
                             io::io_error);
    }
}

TEST_CASE("gltf: many buffers, bufferViews and members take as long as they are many")
{
    auto builder = test::morphing_model(5);
    auto d = document_of(builder.with_data_uri());
    for (int i = 0; i < 20000; ++i)
    {
        d["buffers"].push_back({{"byteLength", 0}, {"uri", "data:;base64,"}});
        d["bufferViews"].push_back({{"buffer", i + 1}, {"byteLength", 0}});
        d["member " + std::to_string(i)] = i;
    }
    for (int i = 0; i < 200000; ++i) d["nodes"].push_back({{"mesh", 0}});
    const auto model = io::impl::parse_gltf(d.dump());
    const std::vector<std::array<vec2, 3>> uv(model.triangles.size());
    CHECK(!io::impl::gltf_files("out.glb", model, uv).empty());
}

TEST_CASE("gltf: GLB whose lengths lie is refused with the byte")
{
    const auto glb = test::textured_model(4).glb();
    const auto refuses = [](std::string bytes, std::size_t at, unsigned value, const char* what)
    {
        if (at > 0) io::impl::store(bytes.data() + at, value, std::endian::little);
        CHECK_THROWS_WITH_AS(io::impl::parse_gltf(bytes, "x.glb"), doctest::Contains(what), io::io_error);
    };
    refuses(glb.substr(0, 19), 0, 0, "x.glb, byte 19: the file ends in the head of GLB");
    refuses(glb, 4, 1, "x.glb, byte 4: GLB of version 1; convert it to glTF 2.0");
    refuses(glb, 8, 0xffffffff, "x.glb, byte 8: the file has");
    refuses(glb, 12, 0xffffffff, "x.glb, byte 12: a chunk of 4294967295 bytes goes beyond the end");
    refuses(glb, 16, 0x004e4942, "byte 12: the first chunk, and no other, must be JSON");
    refuses(glb.substr(0, glb.size() / 2), 0, 0, "x.glb, byte 8: the file has");
}

TEST_CASE("gltf: wrong demands are refused by name")
{
    const auto model = io::impl::parse_gltf(test::morphing_model(5).glb(), "x.glb");
    const std::vector<std::array<vec2, 3>> uv(model.triangles.size());
    CHECK_THROWS_WITH_AS(io::impl::gltf_files("out.obj", model, uv), doctest::Contains("out.obj"), parameter_error);
    CHECK_THROWS_WITH_AS(io::impl::gltf_files("out.glb", model, std::span(uv).first(3)),
                         doctest::Contains("corner_uv: 3 for 50"), parameter_error);
    CHECK_THROWS_WITH_AS(io::impl::gltf_files("out.glb", model, uv, 1),
                         doctest::Contains("primitive 0 of mesh 0 has no TEXCOORD_0"), parameter_error);
    CHECK_THROWS_AS(io::impl::gltf_files("out.glb", model, uv, -1), parameter_error);
    CHECK(io::is_gltf("a/b.GLB"));
    CHECK(io::is_gltf("b.gltf"));
    CHECK(!io::is_gltf("b.glb.obj"));
}

TEST_CASE("gltf: whatever the bytes, there is a model or an error of ours")
{
    for (const auto& builder : {test::textured_model(3), test::skinned_model(3), test::morphing_model(4)})
        for (const auto& sample : {builder.glb(), builder.with_data_uri()})
        {
            for (std::size_t n = 0; n < sample.size(); n += 29) feed_gltf(sample.substr(0, n));
            std::mt19937 random(7);
            for (int trial = 0; trial < 150; ++trial)
            {
                std::string bytes = sample;
                for (int k = 0; k < 1 + trial % 3; ++k)
                {
                    const char digits[] = {'0', '9', '-', '5', '{', ']', '\xff', '\0'};
                    bytes[random() % bytes.size()] = digits[random() % 8];
                }
                feed_gltf(bytes);
            }
        }
}
