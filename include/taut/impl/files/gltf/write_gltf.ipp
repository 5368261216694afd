// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <taut/errors.hpp>
#include <taut/gltf.hpp>
#include <taut/impl/core/core/single.hpp>
#include <taut/impl/core/mesh/describe.hpp>
#include <taut/impl/files/file/write_files.hpp>
#include <taut/impl/files/gltf/arrays.hpp>
#include <taut/impl/files/gltf/container.hpp>
#include <taut/impl/files/gltf/gltf.hpp>
#include <taut/impl/files/gltf/new_gltf.hpp>
#include <taut/impl/files/gltf/split_vertices.hpp>
#include <utility>
#include <vector>

namespace taut::io::impl
{

/// Gives the primitives of a model other texture coordinates.
class gltf_writer
{
public:
    gltf_writer(const gltf_model& model, std::span<const std::array<vec2, 3>> corner_uv, int set,
                gltf_model::numbers numbers)
        : source_(model.source),
          primitives_(primitives_of(model.source)),
          edit_(model.source, layers()),
          set_("TEXCOORD_" + std::to_string(set)),
          type_(numbers == gltf_model::numbers::floats ? gltf_f32 : gltf_u16)
    {
        if (corner_uv.size() != model.triangles.size() || corner_uv.size() != primitives_.triangles)
            throw parameter_error("corner_uv", std::to_string(corner_uv.size()) + " for " +
                                                   std::to_string(model.triangles.size()) +
                                                   " triangles; give three texture coordinates a triangle");
        for (const gltf_primitive& p : primitives_.all)
            if (is_mapped(p)) require_sets_before(p, set);
        std::vector<std::array<gltf_texcoord, 3>> stored(corner_uv.size());
        for (std::size_t t = 0; t < stored.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const vec2 x = gltf_model::rounded(corner_uv[t][k], numbers);
                stored[t][k] = {x.x, x.y};
            }
        split_ = split_vertices(primitives_, model.vertices, stored);
    }

    /// The document with its one buffer.
    std::pair<gltf_json, std::string> write()
    {
        for (gltf_primitive& p : primitives_.all)
        {
            for_each_attribute(p, [&](std::size_t accessor) { ++edit_.uses()[accessor]; });
            if (p.indices) ++edit_.uses()[*p.indices];
        }
        std::vector<std::vector<gltf_primitive*>> members(split_.pools.size());
        for (gltf_primitive& p : primitives_.all) members[p.pool].push_back(&p);
        for (std::size_t pool = 0; pool < members.size(); ++pool)
            if (std::any_of(members[pool].begin(), members[pool].end(), [](auto* p) { return is_mapped(*p); }))
            {
                write_attributes(members[pool], split_.pools[pool]);
                write_indices(members[pool], split_.pools[pool]);
            }
        for (const gltf_primitive& p : primitives_.all) write_members(p);
        std::string bytes = edit_.finish();
        return {std::move(edit_.document()), std::move(bytes)};
    }

private:
    std::size_t layers() const
    {
        std::size_t most = 0;
        for (const gltf_primitive& p : primitives_.all) most = std::max(most, p.layer);
        return most + 1;
    }

    static bool is_mapped(const gltf_primitive& p) { return p.has_triangles() && p.attribute("POSITION"); }

    void require_sets_before(const gltf_primitive& p, int set) const
    {
        if (set < 0) throw parameter_error("texcoord_set", std::to_string(set) + " is negative");
        for (int n = 0; n < set; ++n)
            if (const auto before = "TEXCOORD_" + std::to_string(n); !p.attribute(before))
                throw parameter_error("texcoord_set", p.name + " has no " + before +
                                                          ", and sets are numbered without "
                                                          "gaps; write that one");
    }

    void write_attributes(const std::vector<gltf_primitive*>& members, const gltf_split::pool& pool)
    {
        std::vector<std::vector<std::size_t*>> mapped(pool.uv.size()); // by layer
        std::map<std::size_t, std::vector<std::size_t*>> others;       // by accessor
        for (gltf_primitive* const p : members)
        {
            if (is_mapped(*p) && !p->attribute(set_)) p->attributes.emplace_back(set_, gltf_edit::nothing);
            for (auto& [key, accessor] : p->attributes)
                if (is_mapped(*p) && key == set_)
                    mapped[p->layer].push_back(&accessor);
                else
                    others[accessor].push_back(&accessor);
            for (gltf_attributes& target : p->targets)
                for (auto& attribute : target) others[attribute.second].push_back(&attribute.second);
        }
        if (!pool.origins.empty())
            for (const auto& [accessor, refs] : others)
                edit_.put(refs, grown_accessor(edit_, source_, accessor, pool.origins));
        for (std::size_t layer = 0; layer < mapped.size(); ++layer)
        {
            const auto& refs = mapped[layer];
            const bool one = std::all_of(refs.begin(), refs.end(), [&](auto* ref) { return *ref == *refs[0]; });
            const std::size_t old = one ? *refs[0] : gltf_edit::nothing;
            for (std::size_t* const ref : refs) *ref = old;
            edit_.put(refs, texcoord_accessor(edit_, source_, old, pool.uv[layer], type_));
        }
    }

    /// Primitives draw the new vertices at corners that have them, and none that they did not draw.
    void write_indices(const std::vector<gltf_primitive*>& members, const gltf_split::pool& pool)
    {
        const bool grown = !pool.origins.empty();
        std::map<const gltf_primitive*, std::vector<gltf_primitive*>> copies;
        for (gltf_primitive* const p : members) copies[&primitives_.drawn_by(*p)].push_back(p);
        for (gltf_primitive* const p : members)
        {
            if (p->copy_of || p->twin_of || !(p->indices ? moved(*p) : grown)) continue;
            std::vector<std::uint32_t> drawn = p->count > 0 ? triangles(*p) : drawn_vertices(source_, *p);
            const std::size_t old = p->indices.value_or(gltf_edit::nothing);
            std::vector<std::size_t*> refs;
            for (gltf_primitive* const same : copies[p])
            {
                same->indices = old;
                if (same->count > 0 || same->copy_of) same->mode = gltf_primitive::triangles;
                refs.push_back(&*same->indices);
            }
            edit_.put(refs, index_accessor(edit_, source_, old, drawn, pool.vertices() - 1));
        }
    }

    /// Returns whether corners of a primitive have new vertices.
    bool moved(const gltf_primitive& p) const
    {
        const auto old = primitives_.vertices_of(p.pool);
        for (std::size_t c = p.first; c < p.first + p.count; ++c)
            for (const std::uint32_t v : split_.corners[c])
                if (v >= old) return true;
        return false;
    }

    std::vector<std::uint32_t> triangles(const gltf_primitive& p) const
    {
        std::vector<std::uint32_t> drawn;
        drawn.reserve(3 * p.count);
        for (std::size_t c = p.first; c < p.first + p.count; ++c)
            drawn.insert(drawn.end(), split_.corners[c].begin(), split_.corners[c].end());
        return drawn;
    }

    /// Says in the document what a primitive has become.
    void write_members(const gltf_primitive& p)
    {
        gltf_json& object = edit_.document()["meshes"][p.mesh]["primitives"][p.number];
        for (const auto& [key, accessor] : p.attributes) object["attributes"][key] = accessor;
        for (std::size_t t = 0; t < p.targets.size(); ++t)
            for (const auto& [key, accessor] : p.targets[t]) object["targets"][t][key] = accessor;
        if (p.indices) object["indices"] = *p.indices;
        if (object.contains("mode")) object["mode"] = p.mode;
    }

    const gltf_source& source_;
    gltf_primitives primitives_;
    gltf_edit edit_;
    std::string set_;
    gltf_component type_;
    gltf_split split_;
};

/// Names the images that lie in files as they are named from the folder of the new document.
inline void move_uris(gltf_json& document, const std::filesystem::path& from, const std::filesystem::path& to)
{
    if (!document.contains("images")) return;
    std::error_code failure; // then names stay
    const auto folder = [&](const std::filesystem::path& file) { return absolute(file, failure).parent_path(); };
    const std::string way = relative(folder(from), folder(to), failure).generic_string();
    if (way.empty() || way == ".") return;
    for (gltf_json& image : document["images"])
    {
        if (!image.is_object() || !image.contains("uri") || !image["uri"].is_string()) continue;
        const auto& uri = image["uri"].get_ref<const std::string&>();
        if (!has_scheme(uri) && !uri.starts_with('/')) image["uri"] = percent_encoded(way) + '/' + uri;
    }
}

inline file_to_write file_of(const std::filesystem::path& path, std::string bytes)
{
    return {path, [bytes = std::move(bytes)](atomic_file& file) { file.write(bytes); }};
}

} // namespace taut::io::impl

namespace taut::io
{

vec2 gltf_model::rounded(vec2 uv, numbers as)
{
    if (as == numbers::floats) return {taut::impl::in_single(uv.x), taut::impl::in_single(uv.y)};
    const auto fraction = [](double x) { return std::round(std::clamp(x, 0.0, 1.0) * 65535) / 65535; };
    return {fraction(uv.x), fraction(uv.y)};
}

} // namespace taut::io

namespace taut::io::impl
{

std::optional<std::filesystem::path> gltf_data_file(const std::filesystem::path& path, const gltf_source& source)
{
    if (!is_gltf(path))
        throw parameter_error("path", path.string() + ": glTF is written to .glb and .gltf; name it so");
    if (path.extension().string().size() == 4 || source.data_uris) return {}; // .glb
    const auto data = std::filesystem::path(path).replace_extension(".bin");
    const auto parts = gltf_companions(path);
    require_own_parts(path, std::vector{data}, std::vector<std::filesystem::path>(parts.begin(), parts.end()));
    return data;
}

std::set<std::filesystem::path> gltf_companions(const std::filesystem::path& path)
{
    return impl::places_of_buffers(path).files;
}

/// The files of a document with its one buffer. data: gltf_data_file() of it
inline std::vector<file_to_write> files_of_document(const std::filesystem::path& path, const gltf_model& model,
                                                    const std::optional<std::filesystem::path>& data,
                                                    gltf_json document, std::string bytes)
{
    move_uris(document, model.source.path, path);
    const std::string extension = path.extension().string();
    if (extension.size() == 4) // .glb
        return {file_of(path, join_glb(document.dump(), bytes, model.source.more_chunks, path.string()))};
    std::vector<file_to_write> files;
    if (!data)
        document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + to_base64(bytes);
    else
    {
        document["buffers"][0]["uri"] = percent_encoded(data->filename().string());
        files.push_back(file_of(*data, std::move(bytes)));
    }
    files.push_back(file_of(path, document.dump(2) + '\n'));
    return files;
}

std::vector<file_to_write> gltf_files(const std::filesystem::path& path, const gltf_model& model,
                                      std::span<const std::array<vec2, 3>> corner_uv, int texcoord_set,
                                      gltf_model::numbers numbers)
{
    const auto data = impl::gltf_data_file(path, model.source);
    auto [document, bytes] = impl::gltf_writer(model, corner_uv, texcoord_set, numbers).write();
    return impl::files_of_document(path, model, data, std::move(document), std::move(bytes));
}

} // namespace taut::io::impl

namespace taut::io
{

void gltf_model::write(const std::filesystem::path& path, std::span<const std::array<vec2, 3>> corner_uv,
                       int texcoord_set, numbers as) const
{
    write_files(impl::gltf_files(path, *this, corner_uv, texcoord_set, as));
}

gltf_model::gltf_model(std::span<const vec3> surface_points, std::span<const std::array<idx, 3>> surface_triangles)
{
    if (surface_points.empty() || surface_triangles.empty())
        throw mesh_error(mesh_error::empty, {}, "there are no triangles");
    points.assign(surface_points.begin(), surface_points.end());
    const auto is_drawn = [&](idx v)
    {
        return v >= 0 && static_cast<std::size_t>(v) < points.size() &&
               taut::impl::finite(points[static_cast<std::size_t>(v)]);
    };
    for (const auto& t : surface_triangles)
        triangles.push_back(std::all_of(t.begin(), t.end(), is_drawn) ? t : std::array<idx, 3>{});
    vertices = triangles;
    meshes.assign(surface_triangles.size(), 0);
    materials.assign(surface_triangles.size(), -1);
    std::vector<std::array<idx, 3>> drawn;
    std::copy_if(surface_triangles.begin(), surface_triangles.end(), std::back_inserter(drawn),
                 [&](const auto& t) { return std::all_of(t.begin(), t.end(), is_drawn); });
    const impl::gltf_placing placing(points, drawn);
    source = impl::new_gltf_source(points, triangles, placing.best());
    if (const std::size_t n = placing.collapsed())
        notes.push_back(taut::impl::counted(n, "triangle", "triangles") +
                        " with an area that single precision, which is all that glTF has, does not hold; "
                        "write .obj, or split the surface");
}

} // namespace taut::io
