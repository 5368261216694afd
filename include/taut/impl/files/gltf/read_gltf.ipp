// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <taut/errors.hpp>
#include <taut/gltf.hpp>
#include <taut/impl/files/gltf/container.hpp>
#include <taut/impl/files/gltf/gltf.hpp>
#include <taut/impl/files/gltf/primitives.hpp>
#include <taut/impl/files/surface/point_numbers.hpp>
#include <utility>

namespace taut::io::impl
{

/// Makes the triangles of a model from its source.
class gltf_reader
{
public:
    gltf_reader(gltf_model& model, std::string set) : model_(model), set_(std::move(set)), allowance_(model.source, 2)
    {
    }

    void read()
    {
        const gltf_primitives primitives = primitives_of(model_.source);
        model_.triangles.reserve(primitives.triangles);
        model_.vertices.reserve(primitives.triangles);
        std::optional<std::size_t> mesh;
        for (const gltf_primitive& p : primitives.all)
        {
            if (std::exchange(mesh, p.mesh) != p.mesh) welded_ = {};
            count(p, primitives);
            if (p.count > 0) add(p, primitives.first_vertex[p.pool]);
        }
        if (model_.triangles.empty())
            throw mesh_error(mesh_error::empty, {},
                             model_.source.path + ": there are no triangles; give at least one mesh of them");
        if (std::all_of(model_.texcoord_cells.begin(), model_.texcoord_cells.end(),
                        [](const auto& cell) { return cell[0] < 0; }))
            model_.texcoord_cells.clear();
        add_notes();
    }

private:
    struct element_list
    {
        gltf_accessor accessor;
        std::string bytes;
    };

    const element_list& elements(std::size_t i)
    {
        const auto [at, is_new] = elements_.try_emplace(i);
        if (is_new)
        {
            at->second.accessor = accessor_of(model_.source, i);
            allowance_.take(at->second.accessor.count, "vertices");
            at->second.bytes = all_elements(model_.source, at->second.accessor, "accessor " + std::to_string(i));
        }
        return at->second;
    }

    void add(const gltf_primitive& p, std::size_t first_vertex)
    {
        const element_list& positions = elements(*p.attribute("POSITION"));
        if (positions.accessor.type != "VEC3")
            throw io_error(model_.source.path,
                           p.name + " has a POSITION that is no VEC3; save positions as three floats");
        const idx first_coord = texcoords_of(p);
        const auto drawn = drawn_vertices(model_.source, p);
        for (std::size_t t = 0; t < p.count; ++t)
        {
            std::array<idx, 3> triangle{}, vertices{}, coords{-1, -1, -1};
            const auto corners = corners_of(p, t);
            for (std::size_t k = 0; k < 3; ++k)
            {
                const std::size_t v = drawn[corners[k]];
                triangle[k] = point(positions, v);
                vertices[k] = static_cast<idx>(first_vertex + v);
                if (first_coord >= 0) coords[k] = first_coord + static_cast<idx>(v);
            }
            model_.triangles.push_back(triangle);
            model_.vertices.push_back(vertices);
            model_.texcoord_cells.push_back(coords);
            model_.meshes.push_back(static_cast<idx>(p.mesh));
            model_.materials.push_back(p.material);
        }
        corners_ += 3 * p.count;
    }

    /// The number of the point at vertex v.
    idx point(const element_list& positions, std::size_t v)
    {
        vec3 x;
        for (std::size_t k = 0; k < 3; ++k)
            x[static_cast<int>(k)] = load_number(positions.bytes, positions.accessor, 3 * v + k);
        const auto [number, is_new] = welded_.number(x);
        if (is_new) model_.points.push_back(x);
        return static_cast<idx>(model_.points.size() - welded_.points().size()) + number;
    }

    /// Offset of the texture coordinates of a primitive among those of the model; -1 if it has none.
    idx texcoords_of(const gltf_primitive& p)
    {
        const std::size_t* const accessor = p.attribute(set_);
        if (!accessor) return -1;
        const auto [at, is_new] = first_texcoord_.emplace(*accessor, static_cast<idx>(model_.texcoords.size()));
        if (!is_new) return at->second;
        const element_list& list = elements(*accessor);
        if (list.accessor.type != "VEC2")
            throw io_error(model_.source.path,
                           p.name + " has a " + set_ + " that is no VEC2; save texture coordinates as two numbers");
        for (std::size_t v = 0; v < list.accessor.count; ++v)
            model_.texcoords.emplace_back(load_number(list.bytes, list.accessor, 2 * v),
                                          load_number(list.bytes, list.accessor, 2 * v + 1));
        return at->second;
    }

    void count(const gltf_primitive& p, const gltf_primitives& primitives)
    {
        const auto number = [&](const gltf_primitive& of)
        {
            const std::size_t* const accessor = of.attribute(set_);
            return accessor ? *accessor : SIZE_MAX;
        };
        if (p.copy_of)
            ++(number(p) == number(primitives.all[*p.copy_of]) ? copies_ : unread_);
        else if (!p.has_triangles() || !p.attribute("POSITION"))
            ++others_;
        else if (p.mode != gltf_primitive::triangles)
            ++strips_;
        else if (p.drawn % 3 != 0)
            ++incomplete_;
    }

    void add_notes()
    {
        const auto note = [&](std::size_t n, const char* one, const char* several)
        {
            if (n > 0) model_.notes.push_back(std::to_string(n) + (n == 1 ? one : several));
        };
        if (model_.points.size() < corners_)
            model_.notes.push_back(std::to_string(corners_) + " corners of triangles were joined by position to " +
                                   std::to_string(model_.points.size()) + " points");
        note(strips_, " strip or fan was read as triangles", " strips or fans were read as triangles");
        note(others_, " primitive without triangles was left as it is",
             " primitives without triangles were left as they are");
        note(copies_, " primitive draws the triangles of another one and shares their map",
             " primitives draw the triangles of others and share their maps");
        note(unread_,
             " primitive draws the triangles of another one with other texture coordinates, which are not read",
             " primitives draw the triangles of others with other texture coordinates, which are not read");
        note(incomplete_, " primitive has indices that are left over", " primitives have indices that are left over");
    }

    gltf_model& model_;
    std::string set_;
    std::map<std::size_t, element_list> elements_; // of accessors
    std::map<std::size_t, idx> first_texcoord_;    // of accessors
    point_numbers welded_;                         // points of the mesh
    gltf_allowance allowance_;                     // of elements
    std::size_t corners_ = 0, strips_ = 0, others_ = 0, copies_ = 0, unread_ = 0, incomplete_ = 0;
};

} // namespace taut::io::impl

namespace taut::io
{

bool is_gltf(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    return extension == ".gltf" || extension == ".glb";
}

} // namespace taut::io

namespace taut::io::impl
{

gltf_model parse_gltf(std::string_view bytes, const std::string& path, int texcoord_set)
{
    return model_of(impl::gltf_source_of(bytes, path), texcoord_set);
}

gltf_model model_of(gltf_source source, int texcoord_set)
{
    gltf_model model{};
    model.source = std::move(source);
    impl::gltf_reader(model, "TEXCOORD_" + std::to_string(texcoord_set)).read();
    return model;
}

} // namespace taut::io::impl

namespace taut::io
{

gltf_model read_gltf(const std::filesystem::path& path, int texcoord_set)
{
    return impl::parse_gltf(impl::read_file(path), path.string(), texcoord_set);
}

} // namespace taut::io
