// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <support/gltf_models.hpp>
#include <support/temporary_folder.hpp>
#include <taut/errors.hpp>
#include <taut/gltf.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/impl/files/file/read_file.hpp>
#include <taut/impl/files/gltf/gltf.hpp>
#include <taut/mesh.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using test::gltf_builder;
using test::gltf_json;
using uv_list = std::vector<std::array<vec2, 3>>;

/// A chart for each `size` triangles, in order: vertices between them are split.
uv_list chart_uv(const io::gltf_model& model, std::size_t size)
{
    uv_list uv;
    for (std::size_t t = 0; t < model.triangles.size(); ++t)
    {
        std::array<vec2, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto& p = model.points[static_cast<std::size_t>(model.triangles[t][k])];
            corners[k] = {0.1 + 0.01 * p.x + 0.001 * static_cast<double>(t / size), 0.3 + 0.01 * p.y + 0.02 * p.z};
        }
        uv.push_back(corners);
    }
    return uv;
}

/// The bytes of the element at each corner of each triangle that a primitive draws.
std::vector<std::string> corner_bytes(const io::impl::gltf_source& source, const io::impl::gltf_primitive& p,
                                      std::size_t accessor)
{
    const auto a = io::impl::accessor_of(source, accessor);
    const auto elements = io::impl::all_elements(source, a, "accessor");
    const auto drawn = io::impl::drawn_vertices(source, p);
    std::vector<std::string> bytes;
    const std::size_t triangles = p.mode == 4 ? p.drawn / 3 : p.drawn - 2;
    for (std::size_t t = 0; t < triangles; ++t)
        for (const std::size_t corner : io::impl::corners_of(p, t))
            bytes.push_back(elements.substr(drawn[corner] * a.size, a.size));
    return bytes;
}

/// The document without what may change: where data lies, and what primitives draw.
gltf_json constant_part(const io::impl::gltf_source& source)
{
    gltf_json d = source.document;
    for (const char* const key : {"accessors", "bufferViews", "buffers"}) d.erase(key);
    for (gltf_json& mesh : d["meshes"])
        for (gltf_json& p : mesh["primitives"])
            for (const char* const key : {"attributes", "targets", "indices", "mode"}) p.erase(key);
    return d;
}

gltf_json without_place(gltf_json accessor)
{
    for (const char* const key : {"bufferView", "byteOffset", "count", "sparse"}) accessor.erase(key);
    return accessor;
}

/// What is promised of a file that was written for a model: returns how many vertices are new.
std::size_t require_kept(const io::gltf_model& before, const uv_list& uv, const io::gltf_model& after, int set)
{
    const std::string name = "TEXCOORD_" + std::to_string(set);
    const auto &a = before.source, &b = after.source;
    CHECK(constant_part(a).dump() == constant_part(b).dump());
    REQUIRE(before.triangles == after.triangles);
    CHECK(before.points == after.points);
    CHECK(before.materials == after.materials);
    const auto old = io::impl::primitives_of(a), now = io::impl::primitives_of(b);
    REQUIRE(old.all.size() == now.all.size());
    std::size_t added = 0;
    std::set<std::string> changed; // accessors that may change
    for (std::size_t p = 0; p < old.all.size(); ++p)
    {
        if (p == 0 || old.all[p].pool != old.all[p - 1].pool)
            added += now.vertices_of(now.all[p].pool) - old.vertices_of(old.all[p].pool);
        std::vector<std::pair<std::size_t, std::size_t>> pairs;
        for (const auto& [key, accessor] : old.all[p].attributes)
            if (key != name) pairs.emplace_back(accessor, *now.all[p].attribute(key));
        REQUIRE(old.all[p].targets.size() == now.all[p].targets.size());
        for (std::size_t t = 0; t < old.all[p].targets.size(); ++t)
            for (std::size_t k = 0; k < old.all[p].targets[t].size(); ++k)
                pairs.emplace_back(old.all[p].targets[t][k].second, now.all[p].targets[t][k].second);
        for (const auto& [from, to] : pairs)
        {
            CHECK(corner_bytes(a, old.all[p], from) == corner_bytes(b, now.all[p], to));
            CHECK(without_place(a.document["accessors"][from]) == without_place(b.document["accessors"][to]));
            const auto x = io::impl::accessor_of(a, from), y = io::impl::accessor_of(b, to);
            CHECK(io::impl::all_elements(b, y, "").starts_with(io::impl::all_elements(a, x, "")));
            CHECK(x.sparse.has_value() == y.sparse.has_value());
        }
    }
    for (std::size_t t = 0; t < uv.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
        {
            REQUIRE(after.texcoord_cells[t][k] >= 0);
            CHECK(after.texcoords[static_cast<std::size_t>(after.texcoord_cells[t][k])] ==
                  io::gltf_model::rounded(uv[t][k]));
        }
    return added;
}

/// Vertices that corners need beyond the first of each, counted by other code than the writer's.
std::size_t vertices_wanted(const io::gltf_model& model, const uv_list& uv)
{
    std::map<taut::idx, std::set<std::pair<double, double>>> seen;
    for (std::size_t t = 0; t < uv.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const vec2 x = io::gltf_model::rounded(uv[t][k]);
            seen[model.vertices[t][k]].emplace(x.x, x.y);
        }
    std::size_t n = 0;
    for (const auto& [v, all] : seen) n += all.size() - 1;
    return n;
}

/// Writes a model with charts in each form and looks at what comes back.
void round_trip(const gltf_builder& builder, int set = 0)
{
    const test::temporary_folder folder;
    folder.write(folder / "model.glb", builder.glb());
    folder.write(folder / "uri.gltf", builder.with_data_uri());
    folder.write(folder / "files.gltf", builder.gltf("model%20data.bin"));
    folder.write(folder / "model data.bin", builder.bytes);
    for (const char* const in : {"model.glb", "uri.gltf", "files.gltf"})
        for (const char* const out : {"out.glb", "out.gltf"})
            for (const std::size_t size : {1u, 7u, 1000000u})
            {
                CAPTURE(in);
                CAPTURE(out);
                CAPTURE(size);
                const auto model = io::read_gltf(folder / in, set);
                const auto uv = chart_uv(model, size);
                std::filesystem::remove(folder / "out.bin"); // of another form
                model.write(folder / out, uv, set);
                const auto back = io::read_gltf(folder / out, set);
                CHECK(require_kept(model, uv, back, set) == vertices_wanted(model, uv));
                // Written again, all is in place.
                back.write(folder / "again.glb", uv, set);
                const auto again = io::read_gltf(folder / "again.glb", set);
                CHECK(require_kept(back, uv, again, set) == 0);
                CHECK(again.source.document["bufferViews"].size() == back.source.document["bufferViews"].size());
                CHECK(again.source.buffers[0].size() <= back.source.buffers[0].size() + 8);
            }
}

} // namespace

TEST_CASE("gltf: the program of the document")
{
    const test::temporary_folder folder;
    const auto in = folder / "model.glb", out = folder / "mapped.glb";
    folder.write(in, test::textured_model().glb());
    // [model]
    const auto model = io::read_gltf(in);
    std::vector<std::array<vec2, 3>> uv(model.triangles.size()); // v downwards, one per corner
    for (std::size_t t = 0; t < uv.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const vec3& p = model.points[static_cast<std::size_t>(model.triangles[t][k])];
            uv[t][k] = io::gltf_model::rounded({0.5 + 0.1 * p.x, 0.5 - 0.1 * p.y}); // what the file will hold
        }
    model.write(out, uv);
    // [model]
    CHECK(require_kept(model, uv, io::read_gltf(out), 0) == 0);
}

TEST_CASE("gltf: a textured model with two materials keeps all but what new texture coordinates change")
{
    const auto builder = test::textured_model();
    round_trip(builder);
    round_trip(builder, 1);
}

TEST_CASE("gltf: a skinned model with interleaved attributes keeps its animation")
{
    round_trip(test::skinned_model());
}

TEST_CASE("gltf: targets of morphing, sparse accessors and narrow indices are continued")
{
    round_trip(test::morphing_model());
}

TEST_CASE("gltf: vertices that are split for normals or materials are one point of the surface")
{
    const auto model = io::impl::parse_gltf(test::textured_model(8).glb());
    CHECK(model.points.size() == 64);
    CHECK(model.triangles.size() == 128);
    const mesh<triangle> surface(model.points, model.triangles);
    CHECK(facets(surface).oriented());
    CHECK(model.materials.front() == 0);
    CHECK(model.materials.back() == 1);
    CHECK(model.texcoords[9] == vec2(0.125, 0.125)); // as in the file
    CHECK(model.texcoord_cells == model.vertices);

    // A vertex for each corner.
    const test::torus_arrays torus(6);
    std::vector<float> positions;
    for (const std::uint32_t v : torus.indices)
        for (std::size_t k = 0; k < 3; ++k) positions.push_back(torus.positions[3 * v + k]);
    gltf_builder b;
    b.document["meshes"] = gltf_json::array(
        {{{"primitives", gltf_json::array({{{"attributes", {{"POSITION", b.array(positions, 5126, "VEC3")}}}}})}}});
    const auto split = io::impl::parse_gltf(b.glb());
    CHECK(split.points.size() == 36);
    CHECK(split.texcoord_cells.empty());
    CHECK(facets(mesh<triangle>(split.points, split.triangles)).oriented());
    CHECK(split.notes == std::vector<std::string>{"216 corners of triangles were joined by position to 36 points"});
    round_trip(b);
}

TEST_CASE("gltf: bytes of images, skins and animations are the same, and no data is left that nobody names")
{
    const auto skinned = test::skinned_model(12);
    const auto model = io::impl::parse_gltf(skinned.glb());
    const test::temporary_folder folder;
    model.write(folder / "out.glb", chart_uv(model, 3));
    const auto back = io::read_gltf(folder / "out.glb");
    for (const std::size_t a : {6u, 7u, 8u}) // times, turns, matrices
        CHECK(io::impl::all_elements(model.source, io::impl::accessor_of(model.source, a), "") ==
              io::impl::all_elements(back.source, io::impl::accessor_of(back.source, a), ""));
    std::set<std::size_t> named;
    io::impl::for_each_view_reference(back.source.document,
                                      [&](const gltf_json& v) { named.insert(v.get<std::size_t>()); });
    std::size_t needed = 0;
    for (const std::size_t v : named) needed += io::impl::view_bytes(back.source, v).size() + 7;
    CHECK(named.size() == back.source.document["bufferViews"].size());
    CHECK(back.source.buffers[0].size() <= needed + 8);

    const auto textured = io::impl::parse_gltf(test::textured_model(20).glb());
    textured.write(folder / "out.glb", chart_uv(textured, 3));
    const auto now = io::read_gltf(folder / "out.glb");
    const auto image = [](const io::impl::gltf_source& s)
    { return std::string(io::impl::view_bytes(s, s.document["images"][0]["bufferView"].get<std::size_t>())); };
    CHECK(image(textured.source) == image(now.source));
    CHECK(image(now.source).starts_with("\x89PNG"));
}

TEST_CASE("gltf: indices grow wider where new vertices need it, and only there")
{
    const auto type_after = [](std::uint32_t n, std::size_t chart)
    {
        const auto model = io::impl::parse_gltf(test::morphing_model(n).glb());
        const test::temporary_folder folder;
        model.write(folder / "out.glb", chart_uv(model, chart));
        const auto back = io::read_gltf(folder / "out.glb");
        const auto p = io::impl::primitives_of(back.source).all[0];
        return io::impl::accessor_of(back.source, *p.indices).component;
    };
    CHECK(type_after(5, 1000) == io::impl::gltf_u8);   // 25 vertices
    CHECK(type_after(5, 1) == io::impl::gltf_u8);      // 150
    CHECK(type_after(15, 10000) == io::impl::gltf_u8); // 225
    CHECK(type_after(15, 10) == io::impl::gltf_u16);
    CHECK(type_after(16, 10000) == io::impl::gltf_u8); // 256 vertices, as they were
}

TEST_CASE("gltf: the largest number of a type is no index, as it would end a strip")
{
    const auto type_with = [](std::size_t added)
    {
        const auto model = io::impl::parse_gltf(test::morphing_model(15).glb());
        auto uv = chart_uv(model, 1000000);
        for (std::size_t t = 0; t < added; ++t) uv[t][0] = {static_cast<double>(t), 7};
        const test::temporary_folder folder;
        model.write(folder / "out.glb", uv);
        const auto back = io::read_gltf(folder / "out.glb");
        const auto p = io::impl::primitives_of(back.source).all[0];
        CHECK(p.vertices == 225 + added);
        return io::impl::accessor_of(back.source, *p.indices).component;
    };
    CHECK(type_with(30) == io::impl::gltf_u8);
    CHECK(type_with(31) == io::impl::gltf_u16);
}

TEST_CASE("gltf: what is read back is what was said")
{
    const auto model = io::impl::parse_gltf(test::textured_model(4).glb());
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(0, 1);
    uv_list uv(model.triangles.size());
    for (auto& corners : uv)
        for (vec2& x : corners) x = {number(random), number(random) < 0.1 ? 1e-12 * number(random) : number(random)};
    const test::temporary_folder folder;
    model.write(folder / "out.glb", uv);
    const auto back = io::read_gltf(folder / "out.glb");
    CHECK(require_kept(model, uv, back, 0) == vertices_wanted(model, uv));
    for (const auto& corners : uv)
        for (const vec2& x : corners)
        {
            const vec2 y = io::gltf_model::rounded(x);
            CHECK(io::gltf_model::rounded(y) == y);
            CHECK(std::abs(x.y - y.y) <= 0x1p-24 * x.y);
        }
    // The numbers in the file.
    const auto p = io::impl::primitives_of(back.source).all[0];
    const auto a = io::impl::accessor_of(back.source, *p.attribute("TEXCOORD_0"));
    const auto bytes = io::impl::all_elements(back.source, a, "");
    const auto v = io::impl::drawn_vertices(back.source, p)[0];
    CHECK(io::impl::load_number(bytes, a, 2 * v + 1) == io::gltf_model::rounded(uv[0][0]).y);
}

TEST_CASE("gltf: triangles without texture coordinates lie in one point, and take none of their neighbours along")
{
    const auto model = io::impl::parse_gltf(test::skinned_model(5).glb());
    auto uv = chart_uv(model, 1000);
    auto wanted = uv;
    const double nan = std::nan("");
    uv[3] = {vec2(nan, 0), vec2(0, nan), vec2(nan, nan)};
    uv[7][2].y = std::numeric_limits<double>::infinity();
    wanted[3] = wanted[7] = {vec2(0), vec2(0), vec2(0)};
    const test::temporary_folder folder;
    model.write(folder / "out.glb", uv);
    CHECK(require_kept(model, wanted, io::read_gltf(folder / "out.glb"), 0) == vertices_wanted(model, wanted));
}

TEST_CASE("gltf: fractions of unsigned shorts come back as they were")
{
    const auto model = io::impl::parse_gltf(test::textured_model(5).glb());
    auto uv = chart_uv(model, 1000);
    uv[0][0] = {6554 / 65535.0, 1 / 65535.0};
    uv[0][1] = {0, 1};
    uv[0][2] = {13 / 255.0, 2}; // of bytes; beyond the square
    const test::temporary_folder folder;
    model.write(folder / "out.glb", uv, 0, io::gltf_model::numbers::fractions);
    const auto back = io::read_gltf(folder / "out.glb");
    const auto at = [&](std::size_t k) { return back.texcoords[static_cast<std::size_t>(back.texcoord_cells[0][k])]; };
    CHECK(at(0) == uv[0][0]);
    CHECK(at(1) == uv[0][1]);
    CHECK(at(2) == vec2(13 / 255.0, 1));
    for (std::size_t t = 0; t < uv.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(back.texcoords[static_cast<std::size_t>(back.texcoord_cells[t][k])] ==
                  io::gltf_model::rounded(uv[t][k], io::gltf_model::numbers::fractions));
    const auto a =
        back.source.document["accessors"][*io::impl::primitives_of(back.source).all[0].attribute("TEXCOORD_0")];
    CHECK(a["componentType"] == 5123);
    CHECK(a["normalized"] == true);
    back.write(folder / "floats.glb", uv); // and back to floats
    CHECK(require_kept(back, uv, io::read_gltf(folder / "floats.glb"), 0) == 0);
}

TEST_CASE("gltf: a vertex of ten thousand texture coordinates becomes ten thousand")
{
    gltf_builder b;
    const std::uint32_t n = 10000; // triangles around vertex 0
    std::vector<float> positions{0, 0, 0};
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < n; ++i)
    {
        const float x = static_cast<float>(i);
        positions.insert(positions.end(), {x, 1, 0, x, 1, 1});
        indices.insert(indices.end(), {0, 2 * i + 1, 2 * i + 2});
    }
    b.document["meshes"] = gltf_json::array(
        {{{"primitives", gltf_json::array({{{"attributes", {{"POSITION", b.array(positions, 5126, "VEC3")}}},
                                            {"indices", b.array(indices, 5125, "SCALAR")}}})}}});
    const auto model = io::impl::parse_gltf(b.glb());
    const auto uv = chart_uv(model, 1);
    const test::temporary_folder folder;
    model.write(folder / "out.glb", uv);
    CHECK(require_kept(model, uv, io::read_gltf(folder / "out.glb"), 0) == n - 1);
}

TEST_CASE("gltf: members keep their order and are found, however many there are")
{
    auto builder = test::morphing_model(4);
    auto& extras = builder.document["extras"];
    for (int i = 0; i < 3000; ++i) extras["key " + std::to_string(i * 7919 % 3001)] = i;
    const auto model = io::impl::parse_gltf(builder.glb());
    const test::temporary_folder folder;
    model.write(folder / "out.glb", chart_uv(model, 1));
    const auto back = io::read_gltf(folder / "out.glb");
    CHECK(back.source.document["extras"].dump() == extras.dump());
    CHECK(back.source.document["extras"] == extras);
    auto some = back.source.document["extras"];
    for (int i = 0; i < 3000; ++i)
        if (i % 3 != 0) CHECK(some.erase("key " + std::to_string(i * 7919 % 3001)) == 1);
    CHECK(some.size() == 1000);
    CHECK(some.erase("key 7919") == 0);
    CHECK(some["key " + std::to_string(300 * 7919 % 3001)] == 300);
    for (auto at = some.begin(); some.size() > 5;) at = some.erase(at);
    CHECK(some.dump() ==
          "{\"key " + std::to_string(2985 * 7919 % 3001) + "\":2985,\"key " + std::to_string(2988 * 7919 % 3001) +
              "\":2988,\"key " + std::to_string(2991 * 7919 % 3001) + "\":2991,\"key " +
              std::to_string(2994 * 7919 % 3001) + "\":2994,\"key " + std::to_string(2997 * 7919 % 3001) + "\":2997}");
    CHECK(gltf_json::parse(R"({"a": 1, "b": 2, "a": 3})").dump() == R"({"a":3,"b":2})");
}

TEST_CASE("gltf: further chunks of GLB are kept behind the binary one, and counted in its length")
{
    const auto builder = test::textured_model(4);
    const std::vector<std::string> more{std::string("\4\0\0\0TESTabcd", 12), std::string("\0\0\0\0NULL", 8)};
    const auto model = io::impl::parse_gltf(io::impl::join_glb(builder.gltf(""), builder.bytes, more, "a test"));
    CHECK(model.source.more_chunks == more);
    const test::temporary_folder folder;
    model.write(folder / "out.glb", chart_uv(model, 3));
    const std::string bytes = io::impl::read_file(folder / "out.glb");
    CHECK(io::impl::load_u32(bytes, 8) == bytes.size());
    CHECK(bytes.ends_with(more[0] + more[1]));
    CHECK(io::read_gltf(folder / "out.glb").source.more_chunks == more);
}

TEST_CASE("gltf: an accessor without a bufferView is zeros, and may be longer than the file")
{
    auto builder = test::morphing_model(4);
    const std::size_t n = 60000;
    builder.document["accessors"].push_back({{"componentType", 5126}, {"count", n}, {"type", "VEC3"}});
    const std::size_t zeros = builder.document["accessors"].size() - 1;
    builder.document["meshes"].push_back(
        {{"primitives", gltf_json::array({{{"attributes", {{"POSITION", zeros}}}, {"mode", 0}}})}});
    const auto model = io::impl::parse_gltf(builder.glb());
    const auto all = io::impl::primitives_of(model.source).all;
    CHECK(all[1].vertices == n);
    const auto a = io::impl::accessor_of(model.source, zeros);
    CHECK(io::impl::all_elements(model.source, a, "") == std::string(12 * n, '\0'));
}

TEST_CASE("gltf: a primitive without attributes has no vertices and is left as it is")
{
    auto builder = test::morphing_model(4);
    builder.document["meshes"][0]["primitives"].push_back({{"mode", 4}, {"extras", 7}});
    const auto model = io::impl::parse_gltf(builder.glb());
    const auto p = io::impl::primitives_of(model.source).all[1];
    CHECK(p.vertices == 0);
    CHECK(p.drawn == 0);
    CHECK(model.notes.back() == "1 primitive without triangles was left as it is");
    const auto uv = chart_uv(model, 2);
    const test::temporary_folder folder;
    model.write(folder / "out.glb", uv);
    const auto back = io::read_gltf(folder / "out.glb");
    CHECK(require_kept(model, uv, back, 0) == vertices_wanted(model, uv));
    CHECK(back.source.document["meshes"][0]["primitives"][1] == builder.document["meshes"][0]["primitives"][1]);
}

TEST_CASE("gltf: strips, fans, copies, and lines on the same vertices keep what they draw")
{
    const test::torus_arrays torus(6);
    gltf_builder b;
    const std::size_t position = b.array(torus.positions, 5126, "VEC3", torus.bounds()),
                      strip = b.array(std::vector<std::uint16_t>{0, 6, 1, 7, 2, 8}, 5123, "SCALAR"),
                      fan = b.array(std::vector<std::uint16_t>{14, 15, 21, 20}, 5123, "SCALAR");
    const gltf_json attributes = {{"POSITION", position}};
    b.document["meshes"] = gltf_json::array(
        {{{"primitives", gltf_json::array({{{"attributes", attributes}, {"indices", strip}, {"mode", 5}},
                                           {{"attributes", attributes}, {"indices", fan}, {"mode", 6}},
                                           {{"attributes", attributes}, {"mode", 3}}})}},
         {{"primitives",
           gltf_json::array({{{"attributes", attributes}, {"indices", strip}, {"mode", 5}, {"material", 0}}})}}});
    b.document["materials"] = gltf_json::array({gltf_json::object()});
    const auto model = io::impl::parse_gltf(b.glb());
    CHECK(model.vertices == std::vector<std::array<taut::idx, 3>>{
                                {0, 6, 1}, {6, 7, 1}, {1, 7, 2}, {7, 8, 2}, {15, 21, 14}, {21, 20, 14}});
    CHECK(model.meshes == std::vector<taut::idx>(6, 0));
    CHECK(model.notes.size() == 4);

    const test::temporary_folder folder;
    const auto uv = chart_uv(model, 1);
    model.write(folder / "out.glb", uv);
    const auto back = io::read_gltf(folder / "out.glb");
    CHECK(back.points == model.points);
    CHECK(back.triangles == model.triangles);
    const auto now = io::impl::primitives_of(back.source);
    CHECK(now.all[0].mode == 4);
    CHECK(now.all[1].mode == 4);
    CHECK(now.all[3].copy_of == std::size_t(0));
    CHECK(now.all[3].attribute("TEXCOORD_0"));
    CHECK(!now.all[2].attribute("TEXCOORD_0"));
    CHECK(now.all[2].drawn == torus.vertices); // the line as long as it was
    CHECK(now.all[2].vertices > torus.vertices);

    // With one chart nothing is split, and strips stay.
    model.write(folder / "out.glb", chart_uv(model, 1000));
    CHECK(io::impl::primitives_of(io::read_gltf(folder / "out.glb").source).all[0].mode == 5);
}

TEST_CASE("gltf: quantized coordinates are read, and copied as they are")
{
    const test::torus_arrays torus(6);
    gltf_builder b;
    std::vector<std::int16_t> positions;
    for (std::size_t v = 0; v < torus.vertices; ++v)
        for (std::size_t k = 0; k < 4; ++k)
            positions.push_back(k == 3 ? std::int16_t(0)
                                       : static_cast<std::int16_t>(std::lround(8000 * torus.positions[3 * v + k])));
    const std::vector<std::uint16_t> coords(2 * torus.vertices, 65535);
    const std::size_t view = b.view(io::impl::bytes_of<std::int16_t>(positions), {{"byteStride", 8}});
    gltf_json bounds = {{"normalized", true}, {"min", {-32000, -32000, -8000}}, {"max", {32000, 32000, 8000}}};
    const std::size_t position = b.accessor(view, 5122, "VEC3", torus.vertices, bounds),
                      coord = b.array(coords, 5123, "VEC2", {{"normalized", true}}),
                      indices = b.array(torus.indices, 5125, "SCALAR");
    b.document["extensionsUsed"] = b.document["extensionsRequired"] = {"KHR_mesh_quantization"};
    b.document["meshes"] = gltf_json::array(
        {{{"primitives", gltf_json::array({{{"attributes", {{"POSITION", position}, {"TEXCOORD_0", coord}}},
                                            {"indices", indices}}})}}});
    const auto model = io::impl::parse_gltf(b.glb());
    CHECK(model.points[0].x == doctest::Approx(32000.0 / 32767));
    CHECK(model.texcoords[0] == vec2(1, 1));
    round_trip(b);
}

TEST_CASE("gltf: several meshes and buffers become one buffer; accessors that others name stay for them")
{
    const test::torus_arrays torus(6);
    gltf_builder b;
    const std::size_t position = b.array(torus.positions, 5126, "VEC3", torus.bounds()),
                      indices = b.array(torus.indices, 5125, "SCALAR"),
                      other = b.array(torus.positions, 5126, "VEC3", torus.bounds()),
                      coords = b.array(torus.texcoords, 5126, "VEC2");
    const auto primitive = [&](std::size_t p, gltf_json more = gltf_json::object())
    {
        gltf_json attributes = {{"POSITION", p}};
        attributes.update(more);
        return gltf_json{{"primitives", gltf_json::array({{{"attributes", attributes}, {"indices", indices}}})}};
    };
    // Both meshes have the same indices, and both sets of the second one are one accessor.
    b.document["meshes"] =
        gltf_json::array({primitive(position), primitive(other, {{"TEXCOORD_0", coords}, {"TEXCOORD_1", coords}})});
    gltf_json d = gltf_json::parse(b.with_data_uri());
    const std::size_t first = b.document["bufferViews"][1]["byteOffset"].get<std::size_t>();
    d["buffers"] = gltf_json::array();
    for (const auto& part : {b.bytes.substr(0, first), b.bytes.substr(first)})
        d["buffers"].push_back(
            {{"byteLength", part.size()}, {"uri", "data:application/gltf-buffer;base64," + io::impl::to_base64(part)}});
    for (gltf_json& view : d["bufferViews"])
        if (const auto at = view["byteOffset"].get<std::size_t>(); at >= first)
        {
            view["buffer"] = 1;
            view["byteOffset"] = at - first;
        }
    const auto model = io::impl::parse_gltf(d.dump(), "model.gltf");
    CHECK(model.points.size() == 72); // of different meshes, also where they touch
    const test::temporary_folder folder;
    const auto uv = chart_uv(model, 5);
    model.write(folder / "out.gltf", uv);
    CHECK(folder.entries() == 1);
    const auto back = io::read_gltf(folder / "out.gltf");
    CHECK(back.source.buffers.size() == 1);
    CHECK(require_kept(model, uv, back, 0) == vertices_wanted(model, uv));
}

TEST_CASE("gltf: bytes that two bufferViews name stay for the one that needs no change")
{
    const test::torus_arrays torus(6);
    gltf_builder b;
    std::array<std::size_t, 2> positions{}, indices{};
    for (std::size_t& p : positions) p = b.array(torus.positions, 5126, "VEC3", torus.bounds());
    indices[0] = b.array(torus.indices, 5125, "SCALAR");
    b.document["bufferViews"].push_back(gltf_json(b.document["bufferViews"].back()));
    indices[1] = b.accessor(3, 5125, "SCALAR", torus.indices.size());
    for (const std::size_t m : {0u, 1u})
        b.document["meshes"].push_back({{"primitives", gltf_json::array({{{"attributes", {{"POSITION", positions[m]}}},
                                                                          {"indices", indices[m]}}})}});
    const auto model = io::impl::parse_gltf(b.glb());
    auto uv = chart_uv(model, 1);
    const auto whole = chart_uv(model, 1000000);
    for (std::size_t t = 0; t < uv.size(); ++t)
        if (model.meshes[t] == 1) uv[t] = whole[t];
    const test::temporary_folder folder;
    model.write(folder / "out.glb", uv);
    const auto back = io::read_gltf(folder / "out.glb");
    CHECK(require_kept(model, uv, back, 0) == vertices_wanted(model, uv));
    CHECK(io::impl::view_bytes(back.source, 3) == io::impl::view_bytes(model.source, 3));
}

TEST_CASE("gltf: names of images are those from the folder of the new file; other names stay")
{
    auto builder = test::textured_model(4);
    builder.document["images"] = gltf_json::array({{{"uri", "wood%20a.png"}},
                                                   {{"uri", "data:image/png;base64,AAAA"}},
                                                   {{"uri", "https://a.example/b.png"}},
                                                   {{"uri", "/c.png"}}});
    const test::temporary_folder folder;
    std::filesystem::create_directory(folder / "in put");
    std::filesystem::create_directory(folder / "out");
    folder.write(folder / "in put/a.glb", builder.glb());
    const auto model = io::read_gltf(folder / "in put/a.glb");
    const auto images = [&](const char* name)
    {
        model.write(folder / name, chart_uv(model, 1));
        return io::read_gltf(folder / name).source.document["images"];
    };
    CHECK(images("in put/b.gltf") == builder.document["images"]);
    auto moved = builder.document["images"];
    moved[0]["uri"] = "../in%20put/wood%20a.png";
    CHECK(images("out/b.glb") == moved);
}

TEST_CASE("gltf: a file beside a document is replaced only as its buffer")
{
    const auto builder = test::textured_model(4);
    const test::temporary_folder folder;
    folder.write(folder / "a.gltf", builder.gltf("data.bin"));
    folder.write(folder / "data.bin", builder.bytes);
    const auto model = io::read_gltf(folder / "a.gltf");
    CHECK(model.source.files == io::impl::gltf_companions(folder / "a.gltf"));
    CHECK(model.source.files.size() == 1);
    const auto uv = chart_uv(model, 1);
    const auto refuses = [&](const char* name)
    {
        const auto before = folder.entries();
        CHECK_THROWS_WITH_AS(model.write(folder / name, uv), doctest::Contains("is there already"), io::io_error);
        CHECK(folder.entries() == before);
    };
    refuses("data.gltf"); // the data of the input
    model.write(folder / "a.gltf", uv);
    CHECK(require_kept(model, uv, io::read_gltf(folder / "a.gltf"), 0) > 0);
    CHECK(io::impl::read_file(folder / "data.bin") == builder.bytes);
    model.write(folder / "a.gltf", uv); // a.bin is its own now
    folder.write(folder / "b.bin", "of somebody");
    refuses("b.gltf");
    folder.write(folder / "b.gltf", "no document");
    refuses("b.gltf");
    folder.write(folder / "b.gltf", builder.gltf("a.bin")); // another one's
    refuses("b.gltf");
    if (test::make_link("nowhere", folder / "c.bin")) refuses("c.gltf");
    model.write(folder / "b.glb", uv); // has its data in it
    CHECK(io::impl::read_file(folder / "b.bin") == "of somebody");
    CHECK(io::impl::gltf_companions(folder / "b.glb").empty());
    CHECK(io::impl::gltf_companions(folder / "none.gltf").empty());
    CHECK(io::impl::gltf_companions(folder / ".").empty());
}

TEST_CASE("gltf: a surface becomes a new model that names the vertices it came from")
{
    const test::torus_arrays torus(9);
    std::vector<vec3> points;
    std::vector<std::array<taut::idx, 3>> triangles;
    for (std::size_t i = 0; i < torus.positions.size(); i += 3)
        points.emplace_back(torus.positions[i], torus.positions[i + 1], torus.positions[i + 2]);
    for (std::size_t i = 0; i < torus.indices.size(); i += 3)
        triangles.push_back({static_cast<taut::idx>(torus.indices[i]), static_cast<taut::idx>(torus.indices[i + 1]),
                             static_cast<taut::idx>(torus.indices[i + 2])});
    points.emplace_back(std::nan(""), 0, 0);
    triangles.push_back({0, 1, 81}); // not finite
    triangles.push_back({0, 1, 82}); // not there

    const auto model = io::gltf_model(points, triangles);
    const test::temporary_folder folder;
    const auto uv = chart_uv(model, 4);
    model.write(folder / "out.glb", uv);
    const auto back = io::read_gltf(folder / "out.glb");
    REQUIRE(back.triangles.size() == triangles.size());
    const auto p = io::impl::primitives_of(back.source).all[0];
    const auto numbers = [&](const char* name)
    {
        const auto a = io::impl::accessor_of(back.source, *p.attribute(name));
        const auto bytes = io::impl::all_elements(back.source, a, name);
        std::vector<double> all;
        for (std::size_t k = 0; k < bytes.size() / size_of(a.component); ++k)
            all.push_back(io::impl::load_number(bytes, a, k));
        return all;
    };
    const auto sources = numbers("_SOURCE_VERTEX"), normals = numbers("NORMAL");
    CHECK(p.vertices == 82 + vertices_wanted(model, uv));
    for (std::size_t t = 0; t + 2 < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto v = static_cast<std::size_t>(back.vertices[t][k]);
            const double source = sources[2 * v] + 65536 * sources[2 * v + 1];
            CHECK(source == triangles[t][k]);
            if (v < points.size()) CHECK(source == static_cast<double>(v));
            CHECK(back.points[static_cast<std::size_t>(back.triangles[t][k])] ==
                  points[static_cast<std::size_t>(triangles[t][k])]);
            const double along =
                normals[3 * v] * static_cast<double>(torus.normals[3 * static_cast<std::size_t>(source)]) +
                normals[3 * v + 1] * static_cast<double>(torus.normals[3 * static_cast<std::size_t>(source) + 1]) +
                normals[3 * v + 2] * static_cast<double>(torus.normals[3 * static_cast<std::size_t>(source) + 2]);
            CHECK(along > 0.9);
        }
    CHECK_THROWS_AS(io::gltf_model({}, {}), mesh_error);
}

TEST_CASE("gltf: a new model lies about its middle where floats do not hold it, with doubles in the node")
{
    const test::torus_arrays torus(9);
    const std::vector<std::array<taut::idx, 3>> triangles = [&]
    {
        std::vector<std::array<taut::idx, 3>> list;
        for (std::size_t i = 0; i < torus.indices.size(); i += 3)
            list.push_back({static_cast<taut::idx>(torus.indices[i]), static_cast<taut::idx>(torus.indices[i + 1]),
                            static_cast<taut::idx>(torus.indices[i + 2])});
        return list;
    }();
    const auto grown = [&](const vec3& shift, double size)
    {
        std::vector<vec3> points;
        for (std::size_t i = 0; i < torus.positions.size(); i += 3)
            points.push_back(shift + size * vec3(torus.positions[i], torus.positions[i + 1], torus.positions[i + 2]));
        return points;
    };
    const auto node_of = [](const io::gltf_model& model) { return model.source.document["nodes"][0]; };
    CHECK(node_of(io::gltf_model(grown(vec3(0), 1), triangles)) == gltf_json{{"mesh", 0}});
    CHECK(node_of(io::gltf_model(grown(vec3(7, 0, 0), 1), triangles)) == gltf_json{{"mesh", 0}});
    using place = std::pair<vec3, double>;
    for (const auto& [shift, times] : {place(vec3(500000.1, 5400000.3, 12), 1.0),
                                       {vec3(0), 1e60},
                                       {vec3(0), 1e-80},
                                       {vec3(1e9, 0, -1e9), 1e-3},
                                       {vec3(3e307), 2e307},
                                       {vec3(0), 1e-307}})
    {
        const double size = times; // which lambdas may capture
        CAPTURE(size);
        const auto points = grown(shift, size);
        const auto model = io::gltf_model(points, triangles);
        CHECK(model.notes.empty());
        const auto node = node_of(model);
        const auto a = io::impl::accessor_of(model.source, 0);
        const auto bytes = io::impl::all_elements(model.source, a, "");
        for (std::size_t v = 0; v < points.size(); ++v)
            for (int k = 0; k < 3; ++k)
            {
                const auto i = static_cast<std::size_t>(k);
                const double t = node.contains("translation") ? node["translation"][i].get<double>() : 0,
                             s = node.contains("scale") ? node["scale"][i].get<double>() : 1,
                             x = io::impl::load_number(bytes, a, 3 * v + i);
                CHECK(std::abs(x) <= 0x1p62);
                CHECK(std::abs((t - points[v][k]) / size + s / size * x) <
                      1e-6 + 1e-15 * std::abs(points[v][k] / size));
            }
    }
}

TEST_CASE("gltf: triangles that floats flatten are told, where no middle saves them")
{
    // A speck at each end of a long strip; one of the two can have the floats about 0.
    const std::vector<vec3> points{{0, 0, 0},     {1e6, 0, 0},          {1e6, 1e6, 0},
                                   {5e5, 5e5, 0}, {5e5 + 1e-4, 5e5, 0}, {5e5, 5e5 + 1e-4, 0},
                                   {8e5, 3e5, 0}, {8e5 + 1e-4, 3e5, 0}, {8e5, 3e5 + 1e-4, 0}};
    const std::vector<std::array<taut::idx, 3>> one{{0, 1, 2}, {3, 4, 5}}, two{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
    const auto saved = io::gltf_model(points, one);
    CHECK(saved.notes.empty());
    CHECK(saved.source.document["nodes"][0]["translation"] == gltf_json{5e5, 5e5, 0.0});
    const auto lost = io::gltf_model(points, two);
    REQUIRE(lost.notes.size() == 1);
    CHECK(lost.notes[0].starts_with("1 triangle with an area that single precision"));
}
