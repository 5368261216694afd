// SPDX-License-Identifier: MIT
#include "bake/textured_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <taut/bake.hpp>
#include <taut/impl/charts/bake/tangent_frames.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/files/gltf/vertex_attribute.hpp>

#include "shared/at.hpp"
#include "shared/failure.hpp"
#include "shared/text_table.hpp"

namespace taut::tools
{

namespace
{

const vec2 no_place(std::numeric_limits<double>::quiet_NaN());

/// Leaves out triangles that have no place, or name a point which is not there or not finite, as repair does.
void leave_out_unusable(textured_surface& s)
{
    const auto is_usable = [&](idx v) { return v >= 0 && at(v) < s.points.size() && impl::finite(s.points[at(v)]); };
    for (std::size_t t = 0; t < s.triangles.size(); ++t)
    {
        if (std::all_of(s.triangles[t].begin(), s.triangles[t].end(), is_usable)) continue;
        s.uv[t].fill(no_place);
        s.triangles[t] = {0, 0, 0};
    }
}

/// Takes the normals of corners where they have a direction; those of others stay.
template <class NormalAt>
void take_normals(textured_surface& s, NormalAt normal_at)
{
    for (std::size_t t = 0; t < s.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            if (const vec3 n = impl::normalised(normal_at(t, k)); n != vec3(0.0)) s.normals[t][k] = n;
    s.has_normals = true;
}

/// Tangents of corners, which count in glTF only where there are normals.
std::vector<corner_tangents> read_tangents(const io::gltf_model& model, const io::impl::corner_attribute& normals)
{
    const auto read = io::impl::read_attribute(model, "TANGENT");
    if (read.components != 4 || normals.components != 3) return {};
    std::vector<corner_tangents> tangents(model.triangles.size());
    for (std::size_t t = 0; t < tangents.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const double* const x = read.at(t, k);
            const bool is_known = std::isfinite(normals.at(t, k)[0]);
            tangents[t][k] = vec<4>(is_known ? x[0] : no_place.x, x[1], x[2], x[3] < 0 ? -1 : 1);
        }
    return tangents;
}

/// Normals of the triangles themselves, which glTF has where it says none.
std::vector<std::array<vec3, 3>> flat_normals(const textured_surface& s)
{
    std::vector<std::array<vec3, 3>> normals(s.triangles.size());
    for (std::size_t t = 0; t < normals.size(); ++t)
    {
        const auto x = impl::corners_of(s.points, s.triangles[t]);
        normals[t].fill(impl::normalised(glm::cross(x[1] - x[0], x[2] - x[0]), vec3(0, 0, 1)));
    }
    return normals;
}

void read_model(textured_surface& s, int texcoord_set)
{
    auto& model = s.model.emplace(io::read_gltf(s.path, texcoord_set));
    s.points = model.points;
    s.triangles = model.triangles;
    s.notes = model.notes;
    s.uv.assign(s.triangles.size(), {no_place, no_place, no_place});
    for (std::size_t t = 0; t < model.texcoord_cells.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            if (const idx x = model.texcoord_cells[t][k]; x >= 0)
                s.uv[t][k] = vec2(model.texcoords[at(x)].x, 1 - model.texcoords[at(x)].y);
    leave_out_unusable(s);
    s.normals = flat_normals(s);
    s.has_normals = true;
    const auto normals = io::impl::read_attribute(model, "NORMAL");
    s.tangents = read_tangents(model, normals);
    if (normals.components != 3) return;
    take_normals(s,
                 [&](std::size_t t, std::size_t k)
                 {
                     const double* const n = normals.at(t, k);
                     return vec3(n[0], n[1], n[2]);
                 });
}

void read_soup(textured_surface& s, io::surface_format format)
{
    auto file = io::read_surface_soup(s.path, format);
    if (!file.texcoord_fault.empty()) throw unsuitable_input(file.texcoord_fault + "; correct it");
    if (file.triangles.empty()) throw mesh_error(mesh_error::empty, {}, s.path + ": there are no triangles");
    s.points = std::move(file.points);
    s.triangles = std::move(file.triangles);
    s.notes = std::move(file.notes);
    s.uv.assign(s.triangles.size(), {no_place, no_place, no_place});
    for (std::size_t t = 0; t < file.texcoord_cells.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            if (const idx x = file.texcoord_cells[t][k]; x >= 0) s.uv[t][k] = file.texcoords[at(x)];
    if (s.points.empty()) throw mesh_error(mesh_error::empty, {}, s.path + ": there are no vertices");
    leave_out_unusable(s);
    s.normals = smooth_normals(s.points, s.triangles);
    if (file.normals.empty()) return;
    take_normals(s,
                 [&](std::size_t t, std::size_t k)
                 {
                     const idx n = file.normal_cells.empty() ? s.triangles[t][k] : file.normal_cells[t][k];
                     return n >= 0 && at(n) < file.normals.size() ? file.normals[at(n)] : vec3(0.0);
                 });
}

} // namespace

textured_surface read_textured_surface(const std::string& path, io::surface_format format, int texcoord_set)
{
    textured_surface s;
    s.path = path;
    if (io::is_gltf(path))
        read_model(s, texcoord_set);
    else
        read_soup(s, format);
    return s;
}

bool has_place(const std::array<vec2, 3>& uv)
{
    return std::all_of(uv.begin(), uv.end(), [](const vec2& x) { return impl::finite(x); });
}

corner_uv with_area(corner_uv uv)
{
    for (auto& t : uv)
        if (impl::orient2d(t[0], t[1], t[2]) == 0) t.fill(no_place);
    return uv;
}

vertex_colours read_vertex_colours(const textured_surface& s, io::surface_format format)
{
    vertex_colours colours;
    if (s.model)
    {
        const auto read = io::impl::read_attribute(*s.model, "COLOR_0");
        colours.channels = static_cast<idx>(read.components);
        colours.linear = true;
        for (const double x : read.values) colours.values.push_back(std::isfinite(x) ? static_cast<float>(x) : 1.0f);
    }
    else if (const auto file = io::read_surface_soup(s.path, format); !file.vertices.colours.empty())
    {
        colours.channels = 3;
        for (const auto& t : s.triangles)
            for (const idx v : t)
                for (int k = 0; k < 3; ++k)
                    colours.values.push_back(static_cast<float>(file.vertices.colours.at(at(v))[k]));
    }
    if (colours.channels == 0)
        throw unsuitable_input(s.path + ": its vertices have no colours; those of PLY, OFF and glTF are read");
    return colours;
}

void require_same_triangles(const textured_surface& a, const textured_surface& b)
{
    const auto count = [](const textured_surface& s)
    { return s.path + " has " + tools::count(s.triangles.size(), "triangle", "triangles"); };
    if (a.triangles.size() != b.triangles.size())
        throw unsuitable_input(count(a) + ", " + count(b) +
                               ": give the surface before and after, with the same faces in the same order");
    vec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const auto& t : a.triangles)
        for (const idx v : t)
        {
            if (!impl::finite(a.points[at(v)])) continue;
            low = glm::min(low, a.points[at(v)]);
            high = glm::max(high, a.points[at(v)]);
        }
    const double tolerance = 1e-5 * glm::length(high - low);
    for (std::size_t t = 0; t < a.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3 && std::isfinite(b.uv[t][0].x); ++k)
            if (const double d = glm::length(a.points[at(a.triangles[t][k])] - b.points[at(b.triangles[t][k])]);
                !(d <= tolerance))
                throw unsuitable_input("corner " + std::to_string(k) + " of triangle " + std::to_string(t) + " lies " +
                                       number(d, 3) + " apart in " + a.path + " and " + b.path +
                                       ": give the surface before and after, with the same faces in the same order");
}

} // namespace taut::tools
