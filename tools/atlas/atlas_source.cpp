// SPDX-License-Identifier: MIT
#include "atlas/atlas_source.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <taut/impl/core/core/disjoint_sets.hpp>
#include <taut/impl/core/mesh/describe.hpp>
#include <taut/impl/files/surface/obj_statements.hpp>
#include <taut/impl/files/surface/surface_file_bodies.hpp>
#include <taut/surface_file.hpp>

#include "atlas/placed_points.hpp"
#include "shared/failure.hpp"
#include "shared/repair_report.hpp"
#include "shared/reversed_fans.hpp"

namespace taut::tools
{

namespace
{

/// A number for the material of each face of OBJ text; empty if it names none.
std::vector<idx> face_materials(std::string_view text)
{
    std::map<std::string_view, idx> numbers{{"", 0}}; // of faces before the first name
    std::vector<idx> materials;
    idx now = 0;
    io::impl::scanner in(text, {});
    io::impl::for_each_statement(
        in,
        [&](std::string_view key, const char*)
        {
            if (io::impl::is_face(key)) materials.push_back(now);
            if (key == "usemtl")
                now = numbers.emplace(in.rest_of_line(), static_cast<idx>(numbers.size())).first->second;
        });
    return numbers.size() > 1 ? materials : std::vector<idx>();
}

/// Names that OBJ gives to the faces that follow.
struct face_names
{
    std::string_view object, groups, material;

    /// Calls f with each; several groups in a line are also one, as some write names with blanks.
    template <class F>
    void for_each(F f) const
    {
        for (const std::string_view name : {object, groups, material})
            if (!name.empty()) f(name);
        io::impl::scanner in(groups, {});
        for (std::string_view word = in.word(); !word.empty(); word = in.word()) f(word);
    }
};

/// Calls face(names, changed) for each face of OBJ text; changed: since the face before.
template <class Face>
void for_each_named_face(std::string_view text, Face face)
{
    face_names names;
    bool changed = true;
    io::impl::scanner in(text, {});
    io::impl::for_each_statement(in,
                                 [&](std::string_view key, const char*)
                                 {
                                     if (io::impl::is_face(key)) face(names, std::exchange(changed, false));
                                     std::string_view* const name = key == "o"        ? &names.object
                                                                    : key == "g"      ? &names.groups
                                                                    : key == "usemtl" ? &names.material
                                                                                      : nullptr;
                                     if (!name) return;
                                     *name = in.rest_of_line();
                                     name->remove_suffix(name->size() - (name->find_last_not_of(" \t") + 1));
                                     changed = true;
                                 });
}

/// Returns whether triangles are one piece, by common corners.
bool hang_together(std::span<const std::array<idx, 3>> cells)
{
    impl::disjoint_sets pieces(static_cast<idx>(cells.size()));
    std::map<idx, idx> at_corner; // the first triangle
    std::size_t left = cells.size();
    for (idx c = 0; c < static_cast<idx>(cells.size()); ++c)
        for (const idx v : cells[static_cast<std::size_t>(c)])
            if (const auto [at, first] = at_corner.try_emplace(v, c); !first && pieces.join(at->second, c)) --left;
    return left <= 1;
}

/// OBJ, OFF, PLY or STL; written as OBJ, or as a new glTF document.
class surface_source : public atlas_source
{
public:
    surface_source(io::surface_soup file, const source_options& options)
        : atlas_source(options.origin), file_(std::move(file))
    {
        file_vertices = static_cast<idx>(file_.points.size());
        file_triangles = static_cast<idx>(file_.triangles.size());
        if (!file_.fault && !options.repair) io::impl::ignore_unused_vertices(file_);
        notes = file_.notes;
        texcoord_fault = file_.texcoord_fault;
        if (file_.fault && !options.repair) throw mesh_error(*file_.fault);
        if (options.repair)
            take(tools::repair(file_, options.weld));
        else
        {
            near_edges = describe_near_edges(file_.points, file_.triangles);
            take(mesh<triangle>(file_.points, file_.triangles));
        }
    }

    std::vector<idx> polygons() const override
    {
        if (file_.faces.triangles.empty()) return {};
        return faces();
    }

    std::vector<idx> parts() const override
    {
        const auto materials = face_materials(file_.obj.bytes);
        if (materials.size() != file_.faces.sizes.size()) return {}; // none, or a face that is none
        auto result = faces();
        for (idx& face : result) face = materials[static_cast<std::size_t>(face)];
        return result;
    }

    std::set<std::string> part_names() const override
    {
        std::set<std::string> result;
        for_each_named_face(file_.obj.bytes,
                            [&](const face_names& names, bool changed)
                            {
                                if (changed) names.for_each([&](std::string_view name) { result.emplace(name); });
                            });
        return result;
    }

    std::vector<char> triangles_of(const std::string& name) const override
    {
        std::vector<char> named; // of the faces
        for_each_named_face(file_.obj.bytes,
                            [&](const face_names& names, bool changed)
                            {
                                char is = changed ? 0 : named.back();
                                if (changed) names.for_each([&](std::string_view own) { is = own == name ? 1 : is; });
                                named.push_back(is);
                            });
        std::vector<char> result(surface().cells().size(), 0);
        if (named.size() != file_.faces.sizes.size()) return result; // no OBJ, or a face that is none
        const auto face = faces();
        for (std::size_t c = 0; c < result.size(); ++c) result[c] = named[static_cast<std::size_t>(face[c])];
        return result;
    }

    std::size_t reversed_fans(const corner_map& map) const override
    {
        std::vector<vec2> at(file_.faces.corners.size(), vec2(std::numeric_limits<double>::quiet_NaN()));
        for (std::size_t c = 0; c < map.cells.size(); ++c)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const auto [cell, corner] = origin(c, k);
                at[file_.faces.corner(cell, corner)] = map.uv[static_cast<std::size_t>(map.cells[c][k])];
            }
        return count_reversed_fans(file_.faces, at);
    }

    std::vector<io::file_to_write> files(const std::string& path, const corner_map& map,
                                         io::gltf_model::numbers numbers,
                                         std::vector<std::string>& changes) const override
    {
        if (io::is_gltf(path))
        {
            const auto model = io::gltf_model(file_.points, file_.triangles);
            changes.insert(changes.end(), model.notes.begin(), model.notes.end());
            return gltf_files(path, model, map, 0, numbers, changes);
        }
        std::vector<idx> texcoords(file_.faces.corners.size(), -1);
        std::set<idx> torn; // triangles of polygons that have a corner in two places
        for (std::size_t c = 0; c < map.cells.size(); ++c)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const auto [cell, corner] = origin(c, k);
                idx& t = texcoords[file_.faces.corner(cell, corner)];
                if (t >= 0 && t != map.cells[c][k] && !repairs().empty())
                    torn.insert(static_cast<idx>(c));
                else if (t >= 0 && t != map.cells[c][k])
                    throw no_valid_map("the polygon of triangle " + std::to_string(cell) +
                                       " is bent too far to be in one chart; write the surface as triangles");
                t = map.cells[c][k];
            }
        leave_out_parted(map, torn, texcoords, changes);
        note_mirrored(changes);
        std::vector<vec2> uv(map.uv.begin(), map.uv.end());
        for (vec2& x : uv) x = to_obj(x);
        return {{path, [this, texcoords = std::move(texcoords), uv = std::move(uv)](io::atomic_file& out)
                 { io::write_obj(out, file_, texcoords, uv); }}};
    }

private:
    /// A polygon of which repair has left pieces apart has no place in the map that a program could cut from any
    /// corner.
    void leave_out_parted(const corner_map& map, const std::set<idx>& torn, std::vector<idx>& texcoords,
                          std::vector<std::string>& changes) const
    {
        if (file_.faces.triangles.empty()) return;
        const auto face = faces();
        std::vector<idx> parted;
        for (std::size_t first = 0, last = 0; first < face.size(); first = last)
        {
            while (last < face.size() && face[last] == face[first]) ++last;
            const auto at = torn.lower_bound(static_cast<idx>(first));
            const bool is_torn = at != torn.end() && *at < static_cast<idx>(last);
            if (last - first < 2 || (!is_torn && hang_together(map.cells.subspan(first, last - first)))) continue;
            parted.push_back(face[first]);
            for (std::size_t c = first; c < last; ++c)
                for (std::size_t k = 0; k < 3; ++k)
                {
                    const auto [cell, corner] = origin(c, k);
                    texcoords[file_.faces.corner(cell, corner)] = -1;
                }
        }
        if (!parted.empty())
            changes.push_back(
                taut::impl::list_ids("face", "faces", parted) +
                " of which repair has left pieces apart: without texture coordinates; write as triangles");
    }

    /// The face of the file that each triangle is of.
    std::vector<idx> faces() const
    {
        const auto of_file = file_.faces.of_triangles(); // none: triangles are faces
        std::vector<idx> result(surface().cells().size());
        for (std::size_t c = 0; c < result.size(); ++c)
        {
            const auto cell = origin(c, 0).first;
            result[c] = of_file.empty() ? static_cast<idx>(cell) : of_file[cell];
        }
        return result;
    }

    std::optional<vec2> texcoord(std::size_t cell, std::size_t corner) const override
    {
        const idx t = file_.texcoord_cells.empty() ? -1 : file_.texcoord_cells[cell][corner];
        if (t < 0) return std::nullopt;
        return from_obj(file_.texcoords[static_cast<std::size_t>(t)]);
    }

    io::surface_soup file_;
};

/// glTF, of which all stays but texture coordinates.
class gltf_source : public atlas_source
{
public:
    gltf_source(io::gltf_model model, const source_options& options)
        : atlas_source(options.origin), model_(std::move(model)), set_(options.texcoord_set)
    {
        file_vertices = static_cast<idx>(model_.points.size());
        file_triangles = static_cast<idx>(model_.triangles.size());
        notes = model_.notes;
        const auto bodies = point_meshes();
        if (options.repair)
        {
            const double weld =
                options.weld ? *options.weld : repair_params::usual_tolerance(model_.points, model_.triangles);
            take(repair_surface(model_.points, model_.triangles, {.weld_tolerance = weld, .bodies = bodies}));
        }
        else
        {
            near_edges = describe_near_edges(model_.points, model_.triangles, bodies);
            take(mesh<triangle>(model_.points, model_.triangles));
        }
        try
        {
            draws_ = io::impl::drawn_meshes(model_.source);
        }
        catch (const io::io_error&) // of nodes, which do not matter where meshes are measured alone
        {
            if (options.in_scene) throw;
        }
        find_copies();
        note_shared();
        if (!options.in_scene) return;
        auto points = placed_points(surface(), meshes(), draws_, notes);
        if (points != surface().points()) place(std::move(points));
    }

    std::vector<idx> parts() const override
    {
        std::vector<idx> result(surface().cells().size());
        for (std::size_t c = 0; c < result.size(); ++c) result[c] = model_.materials[origin(c, 0).first];
        return result;
    }

    std::vector<io::file_to_write> files(const std::string& path, const corner_map& map,
                                         io::gltf_model::numbers numbers,
                                         std::vector<std::string>& changes) const override
    {
        return gltf_files(path, model_, map, set_, numbers, changes);
    }

    std::set<std::string> part_names() const override
    {
        std::set<std::string> result;
        for (const auto* const numbers : {&model_.meshes, &model_.materials})
            for (const idx i : std::set<idx>(numbers->begin(), numbers->end()))
                result.merge(numbers == &model_.meshes ? names_of_mesh(i) : names_of_item("materials", i));
        for (const auto& c : copies_) result.merge(names_of_copy(c));
        return result;
    }

    std::vector<char> triangles_of(const std::string& name) const override
    {
        std::map<idx, char> of_mesh, of_material;
        for (const idx m : model_.meshes) of_mesh.try_emplace(m, 0);
        for (const idx m : model_.materials) of_material.try_emplace(m, 0);
        for (auto& [m, is] : of_mesh) is = names_of_mesh(m).contains(name) ? 1 : 0;
        for (auto& [m, is] : of_material) is = names_of_item("materials", m).contains(name) ? 1 : 0;
        std::vector<char> of_copy(model_.triangles.size());
        for (const auto& c : copies_)
            if (names_of_copy(c).contains(name))
                std::fill_n(of_copy.begin() + static_cast<std::ptrdiff_t>(c.first), c.count, 1);
        std::vector<char> result(surface().cells().size());
        for (std::size_t c = 0; c < result.size(); ++c)
        {
            const std::size_t cell = origin(c, 0).first;
            const bool is =
                of_copy[cell] != 0 || of_mesh[model_.meshes[cell]] != 0 || of_material[model_.materials[cell]] != 0;
            result[c] = is ? 1 : 0;
        }
        return result;
    }

private:
    /// A node that draws triangles of another mesh draws that mesh.
    void find_copies()
    {
        drawing_ = draws_.size();
        copies_ = io::impl::copied_triangles(model_.source);
        std::map<std::size_t, std::set<std::size_t>> owners;
        for (const auto& c : copies_)
            if (c.owner != c.mesh) owners[c.mesh].insert(c.owner);
        for (std::size_t i = 0; i < drawing_; ++i)
            for (const std::size_t owner : owners[draws_[i].mesh])
            {
                draws_.push_back(draws_[i]);
                draws_.back().mesh = owner;
            }
    }

    std::set<std::string> names_of_copy(const io::impl::gltf_copy& c) const
    {
        auto result = names_of_mesh(static_cast<idx>(c.mesh));
        result.merge(names_of_item("materials", c.material));
        return result;
    }

    /// Says which meshes have one place for what is drawn several times.
    void note_shared()
    {
        std::map<std::size_t, std::size_t> times;
        for (const auto& draw : draws_) times[draw.mesh] += draw.instances;
        std::size_t meshes = 0, all = 0;
        for (const auto& [m, n] : times)
            if (n > 1)
            {
                ++meshes;
                all += n;
            }
        if (meshes > 0)
            notes.push_back(taut::impl::counted(meshes, "mesh is", "meshes are") + " drawn by several nodes, " +
                            std::to_string(all) +
                            " times in all, which share places in the atlas; for light maps --instances apart gives "
                            "each its own");
    }

    /// The name of an item of a list of the document, if it has one.
    std::set<std::string> names_of_item(const char* list, idx i) const
    {
        if (i < 0 || !model_.source.document.contains(list)) return {};
        const auto& items = model_.source.document[list];
        const auto number = static_cast<std::size_t>(i);
        const auto* const name = number < items.size() ? io::impl::find_in(items[number], {"name"}) : nullptr;
        if (!name || !name->is_string() || name->get_ref<const std::string&>().empty()) return {};
        return {name->get<std::string>()};
    }

    /// That of a mesh, and those of the nodes that draw it.
    std::set<std::string> names_of_mesh(idx i) const
    {
        auto result = names_of_item("meshes", i);
        for (std::size_t k = 0; k < drawing_; ++k)
            if (draws_[k].mesh == static_cast<std::size_t>(i))
                result.merge(names_of_item("nodes", static_cast<idx>(draws_[k].node)));
        return result;
    }

    /// The mesh that each triangle of the surface is of.
    std::vector<idx> meshes() const
    {
        std::vector<idx> result(surface().cells().size());
        for (std::size_t c = 0; c < result.size(); ++c) result[c] = model_.meshes[origin(c, 0).first];
        return result;
    }

    /// The mesh that each point is of.
    std::vector<idx> point_meshes() const
    {
        std::vector<idx> result(model_.points.size(), 0);
        for (std::size_t t = 0; t < model_.triangles.size(); ++t)
            for (const idx v : model_.triangles[t]) result[static_cast<std::size_t>(v)] = model_.meshes[t];
        return result;
    }

    std::optional<vec2> texcoord(std::size_t cell, std::size_t corner) const override
    {
        const idx t = model_.texcoord_cells.empty() ? -1 : model_.texcoord_cells[cell][corner];
        if (t < 0) return std::nullopt;
        return from_gltf(model_.texcoords[static_cast<std::size_t>(t)]);
    }

    io::gltf_model model_;
    std::vector<io::impl::gltf_draw> draws_; ///< of nodes, then again of meshes whose triangles they draw as copies
    std::size_t drawing_ = 0;                ///< how many of them are of nodes
    std::vector<io::impl::gltf_copy> copies_;
    int set_;
};

/// The model with a mesh for each node that draws one.
io::gltf_model parted(io::gltf_model model, const source_options& options)
{
    auto& source = model.source;
    const auto draws = io::impl::drawn_meshes(source);
    for (const auto& draw : draws)
        if (draw.instances > 1)
            throw unsuitable_input(source.path + ": node " + std::to_string(draw.node) + " draws mesh " +
                                   std::to_string(draw.mesh) + ' ' + std::to_string(draw.instances) +
                                   " times by EXT_mesh_gpu_instancing, which has one set of texture coordinates for "
                                   "all; write a node for each instance, or leave out --instances apart");
    const std::size_t before = source.document["meshes"].size();
    io::impl::part_meshes(source, draws);
    const std::size_t more = source.document["meshes"].size() - before;
    model = io::impl::model_of(std::move(source), options.read_texcoord_set);
    if (more > 0)
        model.notes.push_back(taut::impl::counted(more, "mesh was", "meshes were") +
                              " added, so that each node draws its own");
    return model;
}

} // namespace

std::vector<std::array<vec2, 3>> atlas_source::known_texcoords() const
{
    const vec2 none(std::numeric_limits<double>::quiet_NaN());
    std::vector<std::array<vec2, 3>> result(surface().cells().size());
    for (std::size_t c = 0; c < result.size(); ++c)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto [cell, corner] = origin(c, k);
            result[c][k] = texcoord(cell, corner).value_or(none);
        }
    return result;
}

std::vector<std::array<vec2, 3>> atlas_source::texcoords() const
{
    auto result = known_texcoords();
    for (const auto& corners : result)
        for (const vec2& x : corners)
            if (std::isnan(x.x)) return {};
    return result;
}

std::vector<idx> atlas_source::file_faces() const
{
    auto faces = polygons();
    if (faces.empty())
        for (std::size_t c = 0; c < surface().cells().size(); ++c)
            faces.push_back(static_cast<idx>(origin(c, 0).first));
    return faces;
}

std::vector<io::file_to_write> atlas_source::gltf_files(const std::string& path, const io::gltf_model& model,
                                                        const corner_map& map, int set, io::gltf_model::numbers numbers,
                                                        std::vector<std::string>& changes) const
{
    const vec2 none(std::numeric_limits<double>::quiet_NaN());
    std::vector<std::array<vec2, 3>> result(static_cast<std::size_t>(file_triangles), {none, none, none});
    for (std::size_t c = 0; c < map.cells.size(); ++c)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto [cell, corner] = origin(c, k);
            result[cell][corner] = to_gltf(map.uv[static_cast<std::size_t>(map.cells[c][k])]);
        }
    if (const std::size_t out = result.size() - map.cells.size())
        changes.push_back(
            taut::impl::counted(out, "triangle", "triangles") +
            " left out: all corners in one point of the map, as glTF has no triangle without coordinates");
    note_mirrored(changes);
    return io::impl::gltf_files(path, model, result, set, numbers);
}

void atlas_source::note_mirrored(std::vector<std::string>& changes) const
{
    std::vector<idx> mirrored;
    if (repaired_)
        for (std::size_t c = 0; c < repaired_->turned.size(); ++c)
            if (repaired_->turned[c] != 0) mirrored.push_back(repaired_->cell_origins[c]);
    if (!mirrored.empty())
        changes.push_back(taut::impl::list_ids("triangle", "triangles", mirrored) +
                          " turned over by --repair, and written in the order of the file: mirrored in the map; "
                          "turn their corners in the file, or other programs take them for flipped");
}

std::unique_ptr<atlas_source> open_atlas_source(const std::string& path, const source_options& options)
{
    if (io::is_gltf(path))
    {
        auto model = io::read_gltf(path, options.read_texcoord_set);
        return std::make_unique<gltf_source>(options.apart ? parted(std::move(model), options) : std::move(model),
                                             options);
    }
    return std::make_unique<surface_source>(io::read_surface_soup(path, options.format), options);
}

} // namespace taut::tools
