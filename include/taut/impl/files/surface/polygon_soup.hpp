// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/files/surface/split_faces.hpp>
#include <taut/impl/files/surface/surface_file.hpp>
#include <taut/impl/files/surface/surface_file_bodies.hpp>
#include <taut/surface_file.hpp>

namespace taut::io::impl
{

/// Polygons collected by the readers, and their conversion to a surface.
struct polygon_soup
{
    std::vector<vec3> points;
    std::vector<vec2> texcoords;
    file_vertices carried;          // what else the vertices have
    std::vector<idx> corners;       // vertices of all polygons, one after the other
    std::vector<idx> corner_coords; // texcoords of the corners, -1 or missing at the end: none
    std::vector<vec3> normals;      // those that corners name
    std::vector<idx> corner_normals;
    std::vector<idx> sizes;               // corners of each polygon
    std::size_t announced = 0;            // points that are known to follow, if faces stand before them
    bool strict = true;                   // faults are thrown; else the first is kept, and what it is in stays
    std::optional<mesh_error> fault;      // of indices and faces
    std::optional<mesh_error> non_finite; // the first vertex with such a coordinate: no fault unless a face names it
    std::string of_file;                  // the file that has it
    std::string texcoord_fault;           // the first of texture coordinates, which then are none

    static constexpr std::size_t limit = std::numeric_limits<idx>::max();

    /// Makes room for triangles.
    void reserve(std::size_t point_count, std::size_t corner_count)
    {
        points.reserve(point_count);
        corners.reserve(corner_count);
        corner_coords.reserve(corner_count);
        sizes.reserve(corner_count / 3);
    }

    /// make() is the fault, whose place takes time to count: asked for the first one alone.
    template <class Make>
    void note(const Make& make)
    {
        if (strict) throw mesh_error(make());
        if (!fault) fault = make();
    }

    /// where() is the place in the file, asked for errors only. Throws io_error.
    template <class Where>
    void add_point(const vec3& p, const std::string& path, Where where)
    {
        if (points.size() >= limit)
            throw io_error(path, "more vertices than 32-bit numbers can name; split the surface", where());
        if (!non_finite && !is_finite(p))
        {
            non_finite =
                mesh_error(mesh_error::non_finite, {static_cast<idx>(points.size())},
                           place_prefix(path, where()) + "vertex " + std::to_string(points.size()) + is_not_finite);
            of_file = path;
        }
        points.push_back(p);
    }

    template <class Where>
    void add_texcoord(const vec2& x, const std::string& path, Where where)
    {
        if (texcoords.size() >= limit)
            throw io_error(path, "more texture coordinates than 32-bit numbers can name; split the surface", where());
        if (texcoord_fault.empty() && (!std::isfinite(x.x) || !std::isfinite(x.y)))
            texcoord_fault = place_prefix(path, where()) + "a texture coordinate is not a finite number";
        texcoords.push_back(x);
    }

    /// Ends the polygon whose corners are corners[first] and all after it. Throws io_error.
    template <class Where>
    void end_polygon(std::size_t first, const std::string& path, Where where)
    {
        const std::size_t size = corners.size() - first;
        if (size < 3)
        {
            const std::string what = "a face needs three corners or more";
            if (strict) throw io_error(path, what, where());
            note(
                [&]
                {
                    return mesh_error(mesh_error::repeated_vertex, {static_cast<idx>(sizes.size())},
                                      place_prefix(path, where()) + what);
                });
        }
        if (corners.size() > limit)
            throw io_error(path, "more corners than 32-bit numbers can name; split the surface", where());
        sizes.push_back(static_cast<idx>(size));
    }

    /// Appends vertex v of the next face. Throws mesh_error (index_out_of_range).
    template <class Where>
    void add_corner(long long v, const std::string& path, Where where)
    {
        if (v < 0 || v >= static_cast<long long>(std::max(points.size(), announced)))
        {
            note(
                [&]
                {
                    return mesh_error(
                        mesh_error::index_out_of_range, {static_cast<idx>(sizes.size()), static_cast<idx>(v)},
                        place_prefix(path, where()) + "a face names vertex " + std::to_string(v) + ", but there are " +
                            std::to_string(std::max(points.size(), announced)) + ", counted from 0");
                });
            v = -1;
        }
        corners.push_back(static_cast<idx>(v));
    }

    /// Adds what another soup holds; its corners count as those here do, from the start of the file.
    /// False if there is then more than 32-bit numbers can name.
    bool append(polygon_soup&& next)
    {
        if (points.size() + next.points.size() > limit || texcoords.size() + next.texcoords.size() > limit ||
            corners.size() + next.corners.size() > limit || normals.size() + next.normals.size() > limit)
            return false;
        const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
        if (!next.corner_normals.empty()) corner_normals.resize(corners.size(), -1);
        add(points, next.points);
        add(texcoords, next.texcoords);
        add(corners, next.corners);
        add(corner_coords, next.corner_coords);
        add(normals, next.normals);
        add(corner_normals, next.corner_normals);
        add(sizes, next.sizes);
        next = {};
        return true;
    }

    /// Throws mesh_error as the constructor of mesh does. `path` is named in errors.
    surface_file finish(const std::string& path) && { return to_surface_file(std::move(*this).finish(), path); }

    /// Triangles stay as they are; larger polygons are split.
    surface_soup finish() &&
    {
        surface_soup result;
        const bool coords = texcoord_fault.empty() && !texcoords.empty() && !corner_coords.empty();
        const bool named_normals = !corner_normals.empty();
        corner_coords.resize(corners.size(), -1); // the last faces may have had none
        if (named_normals) corner_normals.resize(corners.size(), -1);
        const bool polygons = std::any_of(sizes.begin(), sizes.end(), [](idx n) { return n != 3; });
        if (polygons)
        {
            auto split = face_splitting(points, corners, sizes).run();
            if (split.polygons > 0)
                result.notes.push_back(
                    std::to_string(split.polygons) + (split.polygons == 1 ? " polygon was" : " polygons were") +
                    " split into triangles" +
                    (split.fans > 0 ? " (" + std::to_string(split.fans) + " as a fan, too large for more)" : ""));
            if (split.reversed > 0)
                result.notes.push_back(
                    std::to_string(split.reversed) + (split.reversed == 1 ? " polygon is" : " polygons are") +
                    " concave, and fan triangulation from the first corner flips triangles: triangulate " +
                    (split.reversed == 1 ? "it" : "them") + ", or begin with another corner");
            result.faces.triangles = std::move(split.corners);
        }
        const auto by_triangle = [&](const std::vector<idx>& items)
        {
            std::vector<std::array<idx, 3>> triples(polygons ? result.faces.triangles.size() : sizes.size());
            for (std::size_t c = 0; c < triples.size(); ++c)
                for (std::size_t k = 0; k < 3; ++k) triples[c][k] = items[result.faces.corner(c, k)];
            return triples;
        };
        result.triangles = by_triangle(corners);
        // Vertices come before what is said of them.
        if (auto first = corners.empty() ? non_finite : used_non_finite()) fault = std::move(first);
        if (coords) result.texcoord_cells = by_triangle(corner_coords);
        if (named_normals) result.normal_cells = by_triangle(corner_normals);
        if (const auto empty = std::count(sizes.begin(), sizes.end(), 0); empty > 0)
            result.notes.push_back(std::to_string(empty) + (empty == 1 ? " face" : " faces") +
                                   " without corners left out");
        if (!texcoord_fault.empty())
            result.notes.push_back("the texture coordinates of the file are not used: " + texcoord_fault);
        if (coords) result.texcoords = std::move(texcoords);
        result.points = std::move(points);
        result.normals = named_normals ? std::move(normals) : carried.normals;
        result.faces.sizes = std::move(sizes);
        result.faces.corners = std::move(corners);
        result.vertices = std::move(carried);
        result.fault = std::move(fault);
        result.texcoord_fault = std::move(texcoord_fault);
        return result;
    }

private:
    static constexpr const char* is_not_finite = " has a coordinate that is not a finite number";

    static bool is_finite(const vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

    /// The first vertex of a face with a coordinate that is not finite, if there is one.
    std::optional<mesh_error> used_non_finite() const
    {
        if (!non_finite) return std::nullopt;
        const auto count = static_cast<idx>(points.size());
        idx first = std::numeric_limits<idx>::max();
        for (const idx v : corners)
            if (v >= 0 && v < count && v < first && !is_finite(points[static_cast<std::size_t>(v)])) first = v;
        if (first == std::numeric_limits<idx>::max()) return std::nullopt;
        if (non_finite->ids()[0] == first) return non_finite;
        return mesh_error(mesh_error::non_finite, {first},
                          of_file + ": vertex " + std::to_string(first) + is_not_finite);
    }
};

} // namespace taut::io::impl
