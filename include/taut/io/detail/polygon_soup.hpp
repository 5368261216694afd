// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/io/detail/polygons.hpp>
#include <taut/io/io_error.hpp>
#include <taut/io/surface_file.hpp>

namespace taut::io::detail
{

/// What the readers collect, and what they share in turning it into a surface.
struct polygon_soup
{
    std::vector<vec3> points;
    std::vector<vec2> texcoords;
    file_vertices carried;          // what else the vertices have
    std::vector<idx> corners;       // vertices of all polygons, one after the other
    std::vector<idx> corner_coords; // texcoords of the corners, -1 or missing at the end: none
    std::vector<idx> sizes;         // corners of each polygon

    static constexpr std::size_t limit = std::numeric_limits<idx>::max();

    /// Makes room for triangles.
    void reserve(std::size_t point_count, std::size_t corner_count)
    {
        points.reserve(point_count);
        corners.reserve(corner_count);
        corner_coords.reserve(corner_count);
        sizes.reserve(corner_count / 3);
    }

    /// where() is the place in the file, asked for errors only. Throws mesh_error (non_finite), io_error.
    template <class Where>
    void add_point(const vec3& p, const std::string& path, Where where)
    {
        if (points.size() >= limit) throw io_error(path, "more vertices than 32-bit numbers can name", where());
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            throw mesh_error(mesh_fault::non_finite, {static_cast<idx>(points.size())},
                             place_prefix(path, where()) + "vertex " + std::to_string(points.size()) +
                                 " has a coordinate that is not a finite number");
        points.push_back(p);
    }

    template <class Where>
    void add_texcoord(const vec2& x, const std::string& path, Where where)
    {
        if (texcoords.size() >= limit) throw io_error(path, "more texture coordinates than 32 bits can name", where());
        if (!std::isfinite(x.x) || !std::isfinite(x.y))
            throw io_error(path, "a texture coordinate is not a finite number", where());
        texcoords.push_back(x);
    }

    /// Ends the polygon whose corners are corners[first] and all after it.
    template <class Where>
    void end_polygon(std::size_t first, const std::string& path, Where where)
    {
        const std::size_t size = corners.size() - first;
        if (size < 3) throw io_error(path, "a face needs three corners or more", where());
        if (corners.size() > limit) throw io_error(path, "more corners than 32-bit numbers can name", where());
        sizes.push_back(static_cast<idx>(size));
    }

    /// Appends vertex v of the next face. Throws mesh_error (index_out_of_range).
    template <class Where>
    void add_corner(long long v, const std::string& path, Where where)
    {
        if (v < 0 || v >= static_cast<long long>(points.size()))
            throw mesh_error(mesh_fault::index_out_of_range, {static_cast<idx>(sizes.size()), static_cast<idx>(v)},
                             place_prefix(path, where()) + "a face names vertex " + std::to_string(v) +
                                 ", but there are " + std::to_string(points.size()) + ", counted from 0");
        corners.push_back(static_cast<idx>(v));
    }

    /// Adds what another soup holds; its corners count as those here do, from the start of the file.
    /// False if there is then more than 32-bit numbers can name.
    bool append(polygon_soup&& next)
    {
        if (points.size() + next.points.size() > limit || texcoords.size() + next.texcoords.size() > limit ||
            corners.size() + next.corners.size() > limit)
            return false;
        const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
        add(points, next.points);
        add(texcoords, next.texcoords);
        add(corners, next.corners);
        add(corner_coords, next.corner_coords);
        add(sizes, next.sizes);
        next = {};
        return true;
    }

    /// Triangles stay as they are; larger polygons are split. `path` is named in errors.
    /// Throws mesh_error as the constructor of mesh does.
    surface_file finish(const std::string& path) &&
    {
        std::vector<std::array<idx, 3>> cells, coord_cells, triangles;
        cells.reserve(corners.size() > 2 * sizes.size() ? corners.size() - 2 * sizes.size() : 0);
        const bool coords = !texcoords.empty() && !corner_coords.empty();
        corner_coords.resize(corners.size(), -1); // the last faces may have had none
        if (coords) coord_cells.reserve(cells.capacity());
        const bool polygons = std::any_of(sizes.begin(), sizes.end(), [](idx n) { return n != 3; });
        if (polygons) triangles.reserve(cells.capacity());

        std::size_t split = 0, fans = 0, first = 0;
        ear_clipper clipper;
        std::vector<vec3> polygon;
        for (const idx size : sizes)
        {
            const auto add = [&](std::size_t a, std::size_t b, std::size_t c)
            {
                cells.push_back({corners[first + a], corners[first + b], corners[first + c]});
                if (coords)
                    coord_cells.push_back(
                        {corner_coords[first + a], corner_coords[first + b], corner_coords[first + c]});
                if (polygons)
                    triangles.push_back(
                        {static_cast<idx>(first + a), static_cast<idx>(first + b), static_cast<idx>(first + c)});
            };
            const auto n = static_cast<std::size_t>(size);
            if (n == 3)
                add(0, 1, 2);
            else
            {
                polygon.clear();
                for (std::size_t i = 0; i < n; ++i)
                    polygon.push_back(points[static_cast<std::size_t>(corners[first + i])]);
                clipper.split(polygon, add);
                ++split;
                fans += n > ear_clipper::most_corners ? 1 : 0;
            }
            first += n;
        }
        std::vector<std::string> notes;
        if (split > 0)
            notes.push_back(std::to_string(split) + (split == 1 ? " polygon was" : " polygons were") +
                            " split into triangles" +
                            (fans > 0 ? " (" + std::to_string(fans) + " with more than " +
                                            std::to_string(ear_clipper::most_corners) + " corners as fans)"
                                      : ""));
        if (!coords) texcoords.clear();
        try
        {
            return {mesh<triangle>(std::move(points), std::move(cells)),
                    std::move(texcoords),
                    std::move(coord_cells),
                    std::move(notes),
                    file_faces{std::move(sizes), std::move(corners), std::move(triangles)},
                    std::move(carried)};
        }
        catch (const mesh_error& e)
        {
            throw mesh_error(e.fault(), e.ids(), path + ": " + e.what());
        }
    }
};

} // namespace taut::io::detail
