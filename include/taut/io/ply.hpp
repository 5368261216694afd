// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/io/ply_header.hpp>
#include <taut/io/ply_values.hpp>
#include <taut/io/polygon_soup.hpp>

namespace taut::io
{
namespace detail
{

/// Reads the body of a PLY file from a source of values into a soup.
template <class Source>
class ply_reader
{
public:
    ply_reader(Source source, const std::string& path) : in_(source), path_(path) {}

    surface_file read(const ply_header& header)
    {
        for (const ply_element& e : header.elements)
        {
            if (e.properties.empty()) continue; // its rows take no bytes, however many there are
            require_bytes(e);
            if (e.name == "vertex")
                read_vertices(e);
            else if (e.name == "face")
                read_faces(e);
            else
                for (std::size_t r = 0; r < e.rows; ++r)
                    for (const ply_property& p : e.properties) read_property(p, [](double) {});
        }
        if (soup_.corner_coords.empty() && !soup_.texcoords.empty()) soup_.corner_coords = soup_.corners;
        return std::move(soup_).finish(path_);
    }

private:
    [[noreturn]] void fail(const std::string& what) const { throw io_error(path_, what, in_.place()); }

    auto here() const
    {
        return [this] { return in_.place(); };
    }

    /// Refuses numbers of rows that the file cannot hold before memory is asked for.
    void require_bytes(const ply_element& e) const
    {
        std::size_t row = 0;
        for (const ply_property& p : e.properties) row += in_.smallest(p.counts ? *p.counts : p.type);
        if (e.rows > in_.remaining() / row)
            fail("the file ends too early for " + std::to_string(e.rows) + " rows of element " + e.name);
    }

    /// Lengths and vertex numbers may come in any type, even as floating point.
    long long whole(double x) const
    {
        if (!(std::abs(x) < 1e15) || x != std::floor(x)) fail("expected a whole number");
        return static_cast<long long>(x);
    }

    /// Calls f with the value, or with each item of the list.
    template <class F>
    void read_property(const ply_property& p, F f)
    {
        long long n = 1;
        if (p.counts && (n = whole(in_.next(*p.counts))) < 0) fail("a list of negative length");
        for (; n > 0; --n) f(in_.next(p.type));
    }

    /// 0, 1, 2 for x, y, z; 3, 4 for the texture coordinates under the names that programs give them; -1 for all else.
    static int role_of(std::string_view name)
    {
        if (name == "x") return 0;
        if (name == "y") return 1;
        if (name == "z") return 2;
        if (name == "s" || name == "u" || name == "texture_u") return 3;
        if (name == "t" || name == "v" || name == "texture_v") return 4;
        return -1;
    }

    void read_vertices(const ply_element& e)
    {
        std::vector<int> roles;
        std::array<bool, 5> present{};
        for (const ply_property& p : e.properties)
        {
            const int role = p.counts ? -1 : role_of(p.name);
            const bool first = role >= 0 && !present[static_cast<std::size_t>(role)];
            if (first) present[static_cast<std::size_t>(role)] = true;
            roles.push_back(first ? role : -1);
        }
        if (!present[0] || !present[1] || !present[2]) fail("the vertices have no x, y, z");
        const bool textured = present[3] && present[4];
        soup_.points.reserve(e.rows);
        for (std::size_t r = 0; r < e.rows; ++r)
        {
            std::array<double, 5> value{};
            for (std::size_t k = 0; k < roles.size(); ++k)
                read_property(e.properties[k],
                              [&](double x)
                              {
                                  if (roles[k] >= 0) value[static_cast<std::size_t>(roles[k])] = x;
                              });
            soup_.add_point({value[0], value[1], value[2]}, path_, here());
            if (textured) soup_.add_texcoord({value[3], value[4]}, path_, here());
        }
    }

    void read_faces(const ply_element& e)
    {
        if (soup_.points.empty() && e.rows > 0)
            throw io_error(path_, "the faces stand before the vertices; write the vertex element first");
        const auto is = [](const ply_property& p, std::string_view a, std::string_view b)
        { return p.counts && (p.name == a || p.name == b); };
        soup_.sizes.reserve(e.rows);
        soup_.corners.reserve(3 * e.rows);
        for (std::size_t r = 0; r < e.rows; ++r)
        {
            const std::size_t first = soup_.corners.size();
            coords_.clear();
            for (const ply_property& p : e.properties)
                if (is(p, "vertex_indices", "vertex_index"))
                    read_property(p, [&](double v) { soup_.add_corner(whole(v), path_, here()); });
                else if (is(p, "texcoord", "texcoords"))
                    read_property(p, [&](double x) { coords_.push_back(x); });
                else
                    read_property(p, [](double) {});
            soup_.end_polygon(first, path_, here());
            add_face_coords(soup_.corners.size() - first);
        }
    }

    /// Texture coordinates that come with the faces, u v for each corner.
    void add_face_coords(std::size_t corners)
    {
        if (coords_.empty()) return;
        if (coords_.size() != 2 * corners) fail("expected two texture coordinates for each corner");
        if (soup_.corner_coords.empty()) soup_.texcoords.clear(); // they replace those of the vertices
        soup_.corner_coords.resize(soup_.corners.size() - corners, -1);
        for (std::size_t k = 0; k < corners; ++k)
        {
            soup_.corner_coords.push_back(static_cast<index>(soup_.texcoords.size()));
            soup_.add_texcoord({coords_[2 * k], coords_[2 * k + 1]}, path_, here());
        }
    }

    Source in_;
    const std::string& path_;
    polygon_soup soup_;
    std::vector<double> coords_;
};

} // namespace detail

/// Reads a PLY file: ASCII or binary of either byte order; vertices with x, y, z and perhaps s, t (or u, v), faces as
/// lists vertex_indices (or vertex_index) and perhaps texcoord. Other elements and properties are skipped. Polygons
/// are split into triangles, which the notes say. `path` is named in errors. Throws io_error, mesh_error.
inline surface_file parse_ply(std::string_view bytes, const std::string& path = "PLY data")
{
    detail::scanner in(bytes, path);
    const auto header = detail::read_ply_header(in);
    const auto read = [&](auto source) { return detail::ply_reader(source, path).read(header); };
    switch (header.format)
    {
    case detail::ply_header::little:
        return read(detail::ply_binary<std::endian::little>(in));
    case detail::ply_header::big:
        return read(detail::ply_binary<std::endian::big>(in));
    default:
        return read(detail::ply_ascii(in));
    }
}

} // namespace taut::io
