// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/files/surface/ply/header.hpp>
#include <taut/impl/files/surface/ply/values.hpp>
#include <taut/impl/files/surface/polygon_soup.hpp>

namespace taut::io::impl
{

/// Reads the body of a PLY file from a source of values into a soup.
template <class Source>
class ply_reader
{
public:
    ply_reader(Source source, const std::string& path, bool strict) : in_(source), path_(path)
    {
        soup_.strict = strict;
    }

    polygon_soup read(ply_header& header)
    {
        soup_.carried.comments = std::move(header.comments);
        for (const ply_element& e : header.elements)
            if (e.name == "vertex" && !e.properties.empty()) soup_.announced = e.rows;
        for (const ply_element& e : header.elements)
        {
            if (e.properties.empty()) continue; // its rows take no bytes, however many there are
            require_bytes(e);
            if (e.name == "vertex")
                read_vertices(e);
            else if (e.name == "face")
                read_faces(e);
            else if (e.name == "tristrips")
                read_strips(e);
            else
                for (std::size_t r = 0; r < e.rows; ++r)
                    for (const ply_property& p : e.properties) read_property(p, [](double) {});
        }
        if (soup_.corner_coords.empty() && !soup_.texcoords.empty()) soup_.corner_coords = soup_.corners;
        return std::move(soup_);
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
            fail("the file ends too early for " + std::to_string(e.rows) + " rows of element " + e.name +
                 "; correct its count, or get the file whole");
    }

    /// Lengths and vertex numbers may come in any type, even as floating point.
    long long whole(double x) const
    {
        if (!(std::abs(x) < 1e15) || x != std::floor(x)) fail("expected a whole number; write one");
        return static_cast<long long>(x);
    }

    /// Calls f with the value, or with each item of the list.
    template <class F>
    void read_property(const ply_property& p, F f)
    {
        long long n = 1;
        if (p.counts && (n = whole(in_.next(*p.counts))) < 0) fail("a list of negative length; correct its count");
        for (; n > 0; --n) f(in_.next(p.type));
    }

    /// Kinds of vertex properties, by the first of each group; -1 for all else.
    enum : std::size_t
    {
        position = 0,
        texcoord = 3,
        normal = 5,
        colour = 8,
        role_count = 11
    };

    static int role_of(std::string_view name)
    {
        using names = std::array<std::string_view, 3>; // programs have several for some
        constexpr std::array<names, role_count> known = {names{"x"},
                                                         {"y"},
                                                         {"z"},
                                                         {"s", "u", "texture_u"},
                                                         {"t", "v", "texture_v"},
                                                         {"nx"},
                                                         {"ny"},
                                                         {"nz"},
                                                         {"red", "diffuse_red"},
                                                         {"green", "diffuse_green"},
                                                         {"blue", "diffuse_blue"}};
        for (std::size_t r = 0; r < known.size(); ++r)
            if (!name.empty() && std::find(known[r].begin(), known[r].end(), name) != known[r].end())
                return static_cast<int>(r);
        return -1;
    }

    /// Value of full colour: the maximum of an integer type.
    static double full(ply_type t) { return t == ply_type::uint8 ? 255 : t == ply_type::uint16 ? 65535 : 1; }

    void read_vertices(const ply_element& e)
    {
        std::vector<int> roles;
        std::array<double, role_count> unit{}; // 0: there is no such property
        for (const ply_property& p : e.properties)
        {
            int role = p.counts ? -1 : role_of(p.name);
            if (role >= 0 && unit[static_cast<std::size_t>(role)] != 0) role = -1; // the first one counts
            if (role >= 0)
                unit[static_cast<std::size_t>(role)] = static_cast<std::size_t>(role) >= colour ? full(p.type) : 1;
            roles.push_back(role);
        }
        const auto has = [&](std::size_t first, std::size_t count)
        { return std::all_of(&unit[first], &unit[first] + count, [](double u) { return u != 0; }); };
        if (!has(position, 3)) fail("the vertices have no x, y, z; give them these properties");
        const bool textured = has(texcoord, 2), normals = has(normal, 3), colours = has(colour, 3);
        soup_.points.reserve(e.rows);
        std::array<double, role_count> value{};
        std::array<std::string_view, 3> text;
        const auto three = [&value](std::size_t i) { return vec3(value[i], value[i + 1], value[i + 2]); };
        for (std::size_t r = 0; r < e.rows; ++r)
        {
            for (std::size_t k = 0; k < roles.size(); ++k)
                read_property(e.properties[k],
                              [&](double x)
                              {
                                  if (roles[k] < 0) return;
                                  const auto role = static_cast<std::size_t>(roles[k]);
                                  value[role] = x / unit[role];
                                  if (role < text.size()) text[role] = in_.text();
                              });
            soup_.add_point(three(position), path_, here());
            if (textured && soup_.corner_coords.empty())
                soup_.add_texcoord({value[texcoord], value[texcoord + 1]}, path_, here());
            if (normals) soup_.carried.normals.push_back(three(normal));
            if (colours) soup_.carried.colours.push_back(three(colour));
            if (!text[0].empty()) add_position(text);
        }
    }

    void add_position(const std::array<std::string_view, 3>& text)
    {
        auto& positions = soup_.carried.positions;
        for (std::size_t k = 0; k < 3; ++k)
        {
            if (k > 0) positions.append(" ");
            append_written(positions, text[k]);
        }
        positions.end();
    }

    static bool is(const ply_property& p, std::string_view a, std::string_view b)
    {
        return p.counts && (p.name == a || p.name == b);
    }

    /// Triangle strips: each vertex ends a triangle with the two before it, every second one turned; -1 begins a new
    /// strip, and a vertex named twice joins two.
    void read_strips(const ply_element& e)
    {
        std::array<long long, 3> last{};
        for (std::size_t r = 0; r < e.rows; ++r)
        {
            std::size_t length = 0; // of the strip
            const auto add = [&](double value)
            {
                const long long v = whole(value);
                length = v == -1 ? 0 : length + 1;
                last = {last[1], last[2], v};
                if (length < 3 || last[0] == last[1] || last[1] == last[2] || last[2] == last[0]) return;
                const std::size_t first = soup_.corners.size(), turned = length % 2 == 0 ? 1 : 0;
                for (const std::size_t k : {turned, 1 - turned, std::size_t{2}})
                    soup_.add_corner(last[k], path_, here());
                soup_.end_polygon(first, path_, here());
            };
            for (const ply_property& p : e.properties)
                if (is(p, "vertex_indices", "vertex_index"))
                    read_property(p, add);
                else
                    read_property(p, [](double) {});
        }
    }

    void read_faces(const ply_element& e)
    {
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
        if (coords_.size() != 2 * corners)
            fail("expected two texture coordinates for each corner; correct the list, or leave it out");
        if (soup_.corner_coords.empty()) soup_.texcoords.clear(); // they replace those of the vertices
        soup_.corner_coords.resize(soup_.corners.size() - corners, -1);
        for (std::size_t k = 0; k < corners; ++k)
        {
            soup_.corner_coords.push_back(static_cast<idx>(soup_.texcoords.size()));
            soup_.add_texcoord({coords_[2 * k], coords_[2 * k + 1]}, path_, here());
        }
    }

    Source in_;
    const std::string& path_;
    polygon_soup soup_;
    std::vector<double> coords_;
};

inline polygon_soup read_ply(std::string_view bytes, const std::string& path, bool strict)
{
    scanner in(bytes, path);
    auto header = read_ply_header(in);
    const auto read = [&](auto source) { return ply_reader(source, path, strict).read(header); };
    switch (header.format)
    {
    case ply_header::little:
        return read(ply_binary<std::endian::little>(in));
    case ply_header::big:
        return read(ply_binary<std::endian::big>(in));
    default:
        return read(ply_ascii(in));
    }
}

/// Reads a PLY file: ASCII or binary of either byte order; vertices with x, y, z and perhaps s, t (or u, v), faces as
/// lists vertex_indices (or vertex_index) and perhaps texcoord, and triangle strips. Normals, colours and comments are
/// kept for write_obj; other elements and properties are skipped. Polygons are split into triangles, which the notes
/// say. `path` is named in errors. Throws io_error, mesh_error.
inline surface_file parse_ply(std::string_view bytes, const std::string& path = "PLY data")
{
    return impl::read_ply(bytes, path, true).finish(path);
}

/// The same as it is. Throws io_error.
inline surface_soup parse_ply_soup(std::string_view bytes, const std::string& path = "PLY data")
{
    return impl::read_ply(bytes, path, false).finish();
}

} // namespace taut::io::impl
