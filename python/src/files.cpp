// SPDX-License-Identifier: MIT
// Files of surfaces, volumes and models.
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include <taut/files.hpp>
#include <taut/gltf.hpp>
#include <taut/impl/core/compute/program/private_folder.hpp>
#include <taut/read.hpp>
#include <taut/write.hpp>

#include "bindings.hpp"
#include "reports.hpp"

namespace taut::python
{

namespace
{

using corner_uv = std::vector<std::array<vec2, 3>>;

/// Coordinates of corners as rows, three a triangle; NaN where there is none.
nb::object rows_of_corners(const std::vector<vec2>& texcoords, const std::vector<std::array<idx, 3>>& cells)
{
    if (texcoords.empty() || cells.empty()) return nb::none();
    std::vector<vec2> rows;
    for (const auto& cell : cells)
        for (const idx t : cell)
            rows.push_back(t >= 0 && static_cast<std::size_t>(t) < texcoords.size()
                               ? texcoords[static_cast<std::size_t>(t)]
                               : vec2(std::numeric_limits<double>::quiet_NaN()));
    return array_of<2>(std::move(rows));
}

nb::dict read_surface(const std::string& path)
{
    io::surface_soup soup;
    {
        nb::gil_scoped_release unlocked;
        soup = io::read_surface_soup(path);
    }
    nb::dict d;
    d["kind"] = "surface";
    d["corner_uv"] = rows_of_corners(soup.texcoords, soup.texcoord_cells);
    d["polygons"] = soup.faces.triangles.empty() ? nb::none() : array_of(soup.faces.of_triangles());
    d["notes"] = texts(soup.notes);
    d["F"] = array_of(soup.triangles);
    d["V"] = array_of<3>(std::move(soup.points));
    return d;
}

nb::dict read_model(const std::string& path, int set)
{
    io::gltf_model model;
    {
        nb::gil_scoped_release unlocked;
        model = io::read_gltf(path, set);
    }
    // As elsewhere, v runs upwards.
    for (vec2& t : model.texcoords) t.y = 1 - t.y;
    nb::dict d;
    d["kind"] = "model";
    d["corner_uv"] = rows_of_corners(model.texcoords, model.texcoord_cells);
    d["polygons"] = nb::none();
    d["materials"] = array_of(model.materials);
    d["notes"] = texts(model.notes);
    d["F"] = array_of(model.triangles);
    d["V"] = array_of<3>(std::move(model.points));
    return d;
}

nb::dict read_volume(const std::string& path, int zone)
{
    io::volume_file file;
    {
        nb::gil_scoped_release unlocked;
        file = io::read_volume_file(path, io::volume_format::automatic, zone);
    }
    nb::dict d, cells, groups;
    for (const auto& block : file.cells)
    {
        const auto& shape = io::impl::shape_of(block.kind);
        if (!cells.contains(shape.names)) cells[shape.names] = nb::list();
        std::vector<double> corners(block.corners.begin(), block.corners.end());
        nb::cast<nb::list>(cells[shape.names])
            .append(array_of(std::move(corners), static_cast<std::size_t>(shape.corners)));
    }
    for (const auto& g : file.groups) groups[text(g.name)] = array_of(g.vertices);
    d["kind"] = "volume";
    d["dimension"] = file.dimension;
    d["format"] = text(file.format);
    d["cells"] = cells;
    d["groups"] = groups;
    d["notes"] = texts(file.notes);
    d["rest"] = file.rest.empty() ? nb::none() : array_of<3>(file.rest);
    d["V"] = array_of<3>(file.points);
    return d;
}

/// corners: three rows a triangle
corner_uv corners_of(const array& rows, std::size_t triangles)
{
    const auto points = points_of<2>(rows, "uv");
    if (points.size() != 3 * triangles)
        throw parameter_error("uv", std::to_string(points.size()) + " rows for the corners of " +
                                        std::to_string(triangles) + " triangles; give three a triangle");
    corner_uv corners(triangles);
    for (std::size_t i = 0; i < points.size(); ++i) corners[i / 3][i % 3] = points[i];
    return corners;
}

/// What f returns, for other threads to go on meanwhile: one may be the reader of a pipe that f writes.
template <class F>
auto unlocked(F&& f)
{
    const nb::gil_scoped_release released;
    return f();
}

/// The file like `like` with texture coordinates by corners, equal ones shared.
void write_surface_uv(const std::string& path, const std::string& like, const array& rows)
{
    const auto file = unlocked([&] { return io::read_surface_soup(like); });
    const auto corners = corners_of(rows, file.triangles.size());
    std::map<std::pair<double, double>, idx> known;
    std::vector<vec2> uv;
    std::vector<idx> texcoords(file.faces.corners.size(), -1);
    for (std::size_t c = 0; c < corners.size(); ++c)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const vec2 x = corners[c][k];
            if (!(std::isfinite(x.x) && std::isfinite(x.y))) continue;
            const auto [at, fresh] = known.try_emplace({x.x, x.y}, static_cast<idx>(uv.size()));
            if (fresh) uv.push_back(x);
            texcoords[file.faces.corner(c, k)] = at->second;
        }
    unlocked(
        [&] {
            io::write_obj(std::filesystem::path(path), file, std::span<const idx>(texcoords),
                          std::span<const vec2>(uv));
        });
}

void write_model_uv(const std::string& path, const std::string& like, const array& rows, int set)
{
    const auto model = unlocked([&] { return io::read_gltf(like, set); });
    auto corners = corners_of(rows, model.triangles.size());
    for (auto& c : corners)
        for (vec2& t : c) t.y = 1 - t.y;
    unlocked([&] { model.write(path, corners, set); });
}

/// Arrays as a new model.
void write_new_model(const std::string& path, const array& V, const array& F, const array& rows)
{
    const auto points = places_of(V, "V");
    const auto triangles = cells_of<3>(F, "F");
    auto corners = corners_of(rows, triangles.size());
    for (auto& c : corners)
        for (vec2& t : c) t.y = 1 - t.y;
    unlocked([&] { io::gltf_model(points, triangles).write(path, corners); });
}

void write_surface_moved(const std::string& path, const std::string& like, const array& x)
{
    const auto file = unlocked([&] { return io::read_surface_file(like); });
    const auto places = places_of(x, "x");
    unlocked(
        [&]
        {
            io::atomic_file out(path);
            file.write(out, places);
            out.commit();
        });
}

/// Arrays as a new OBJ, with one texture coordinate a vertex.
void write_new_surface(const std::string& path, const array& V, const array& F, const array& uv)
{
    const auto m = mesh_of<triangle>(V, F);
    const auto x = points_of<2>(uv, "uv");
    unlocked([&] { io::write_obj(std::filesystem::path(path), m, std::span<const vec2>(x)); });
}

void write_volume_moved(const std::string& path, const std::string& like, const array& x, int zone)
{
    const auto file = unlocked([&] { return io::read_volume_file(like, io::volume_format::automatic, zone); });
    auto points = places_of(x, "x");
    if (x.ndim() == 2 && x.shape(1) == 2)
        for (std::size_t v = 0; v < points.size() && v < file.points.size(); ++v) points[v].z = file.points[v].z;
    unlocked([&] { file.write(path, points); });
}

/// Files of bytes that appear together or not at all.
void write_files(const nb::list& given)
{
    std::vector<io::file_to_write> files;
    std::vector<nb::bytes> kept;
    for (const nb::handle pair : given)
    {
        kept.push_back(nb::cast<nb::bytes>(pair[1]));
        const std::string_view bytes(kept.back().c_str(), kept.back().size());
        files.push_back({nb::cast<std::string>(pair[0]), [bytes](io::atomic_file& file) { file.write(bytes); }});
    }
    unlocked([&] { io::write_files(files); });
}

} // namespace

void add_files(nb::module_& m)
{
    // As all files are written: complete or not at all, through no link that somebody else has planted, with the
    // permissions of what it replaces.
    m.def("write_file",
          [](const std::string& path, const nb::bytes& bytes)
          {
              const std::string_view text(bytes.c_str(), bytes.size());
              unlocked([&] { io::write_file(path, text); });
          });
    // Why a folder of code (caches, drivers) is not the user's alone; empty if it is.
    m.def("fault_of_folder", [](const std::string& path) { return impl::fault_of_folder(path); });
    m.def("is_model", [](const std::string& path) { return io::is_gltf(path); });
    m.def("read_surface", &read_surface);
    m.def("read_model", &read_model);
    m.def("read_volume", &read_volume);
    m.def("write_surface_uv", &write_surface_uv);
    m.def("write_model_uv", &write_model_uv);
    m.def("write_new_model", &write_new_model);
    m.def("write_surface_moved", &write_surface_moved);
    m.def("write_new_surface", &write_new_surface);
    m.def("write_volume_moved", &write_volume_moved);
    m.def("write_files", &write_files);
}

} // namespace taut::python
