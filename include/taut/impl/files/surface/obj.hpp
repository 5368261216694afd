// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/files/file/scanner.hpp>
#include <taut/impl/files/surface/obj_statements.hpp>
#include <taut/impl/files/surface/polygon_soup.hpp>
#include <taut/impl/files/surface/surface_file_bodies.hpp>

namespace taut::io::impl
{

/// Reads OBJ statements into a soup. A reader of a piece of a file takes in those of the following pieces.
class obj_reader
{
public:
    obj_reader(std::string_view text, const std::string& path, bool strict) : in_(text, path) { soup_.strict = strict; }

    void require_text() const { in_.require_text(); }

    void read()
    {
        // What a file of triangles has, about; memory that is not used costs nothing.
        soup_.reserve(in_.remaining() / 64, in_.remaining() / 10);
        for_each_statement(in_,
                           [this](std::string_view key, const char* begin)
                           {
                               if (key.size() == 1 && key[0] == 'v')
                                   soup_.add_point(in_.numbers<3>(), in_.path(), in_.here());
                               else if (is_face(key))
                                   read_face(begin);
                               else if (key == "vt")
                                   read_texcoord(begin);
                               else if (key == "vn" && !soup_.strict)
                                   read_normal();
                           });
    }

    /// The first byte of the first vt or f statement; null if there is none.
    const char* body() const { return body_; }
    std::size_t corner_count() const { return soup_.corners.size(); }
    bool faulty() const
    {
        return soup_.fault.has_value() || soup_.non_finite.has_value() || !soup_.texcoord_fault.empty();
    }

    /// False if some statement counts back from its place, which a piece does not know.
    bool absolute() const { return absolute_; }

    /// Makes room for what some readers have read.
    void reserve(const std::vector<obj_reader>& pieces)
    {
        std::size_t points = 0, corners = 0;
        for (const auto& p : pieces) points += p.soup_.points.size(), corners += p.soup_.corners.size();
        soup_.reserve(points, corners);
    }

    /// Takes in what stands in the following piece. False if that makes too much of anything.
    bool append(obj_reader&& next)
    {
        if (!soup_.append(std::move(next.soup_))) return false;
        // Where in the file the largest numbers stand is asked only when a whole file is read.
        vertices_.number = std::max(vertices_.number, next.vertices_.number);
        coords_.number = std::max(coords_.number, next.coords_.number);
        return true;
    }

    /// Returns whether the faces name only what there is.
    bool in_range() const
    {
        const auto within = [](const largest& most, std::size_t count)
        { return most.number <= static_cast<long long>(count); };
        return within(vertices_, soup_.points.size()) && within(coords_, soup_.texcoords.size());
    }

    surface_soup finish()
    {
        if (auto what = beyond(vertices_, soup_.points.size(), "vertex"); !what.empty())
            soup_.note(
                [&]
                {
                    return mesh_error(mesh_error::index_out_of_range,
                                      {static_cast<idx>(vertices_.face), static_cast<idx>(vertices_.number - 1)}, what);
                });
        if (soup_.texcoord_fault.empty())
            soup_.texcoord_fault = beyond(coords_, soup_.texcoords.size(), "texture coordinate");
        // What is not there is none; where readers are strict, there are no normals.
        drop_beyond(soup_.corner_normals, soup_.normals.size());
        return std::move(soup_).finish();
    }

private:
    /// The largest number that a face names, where, and by which face: the vertices may follow later in the file.
    struct largest
    {
        long long number = 0;
        const char* position = nullptr;
        std::size_t face = 0;
    };

    void read_texcoord(const char* begin)
    {
        if (body_ == nullptr) body_ = begin;
        const double u = in_.number();
        // A texture of one dimension has no v.
        soup_.add_texcoord({u, in_.content_ends() ? 0.0 : in_.number()}, in_.path(), in_.here());
    }

    /// Reads a normal; an invalid one is stored as not a number, as normals may not be needed.
    void read_normal()
    {
        soup_.normals.emplace_back(std::numeric_limits<double>::quiet_NaN());
        try
        {
            soup_.normals.back() = in_.numbers<3>();
        }
        catch (const io_error&)
        {
        }
    }

    void read_face(const char* begin)
    {
        if (body_ == nullptr) body_ = begin;
        const std::size_t first = soup_.corners.size();
        while (!in_.content_ends())
        {
            const char* const position = in_.position();
            const obj_corner c = read_obj_corner(in_);
            soup_.corners.push_back(resolve_vertex(c.vertex, position));
            soup_.corner_coords.push_back(c.has_texcoord ? resolve_texcoord(c.texcoord, position) : -1);
            if (c.has_normal && !soup_.strict) add_corner_normal(c.normal);
        }
        soup_.end_polygon(first, in_.path(), in_.here());
    }

    /// Adds the normal of the last corner; an invalid index means none.
    void add_corner_normal(long long i)
    {
        absolute_ = absolute_ && i > 0;
        const long long n = i > 0 ? i - 1 : static_cast<long long>(soup_.normals.size()) + i;
        soup_.corner_normals.resize(soup_.corners.size() - 1, -1);
        soup_.corner_normals.push_back(
            i == 0 || n < 0 || n > static_cast<long long>(polygon_soup::limit) ? -1 : static_cast<idx>(n));
    }

    /// A number counted from 1, or back from -1, the last of `count`. The result is counted from 0; nothing if it
    /// cannot be.
    std::optional<idx> resolve(long long i, std::size_t count, largest& most, const char* position)
    {
        absolute_ = absolute_ && i > 0;
        const long long zero_based = i > 0 ? i - 1 : static_cast<long long>(count) + i;
        if (i == 0 || zero_based < 0 || zero_based > static_cast<long long>(polygon_soup::limit)) return std::nullopt;
        if (zero_based >= most.number) most = {zero_based + 1, position, soup_.sizes.size()};
        return static_cast<idx>(zero_based);
    }

    idx resolve_vertex(long long i, const char* position)
    {
        const auto v = resolve(i, soup_.points.size(), vertices_, position);
        if (!v && soup_.strict) in_.fail(wrong_number(i, soup_.points.size()));
        if (!v)
            soup_.note(
                [&]
                {
                    return mesh_error(mesh_error::index_out_of_range, {static_cast<idx>(soup_.sizes.size()), -1},
                                      place_of(position) + wrong_number(i, soup_.points.size()));
                });
        return v.value_or(-1);
    }

    idx resolve_texcoord(long long i, const char* position)
    {
        const auto t = resolve(i, soup_.texcoords.size(), coords_, position);
        if (!t && soup_.texcoord_fault.empty())
            soup_.texcoord_fault = place_of(position) + wrong_number(i, soup_.texcoords.size());
        return t.value_or(-1);
    }

    std::string place_of(const char* position) const { return place_prefix(in_.path(), in_.line_of(position)); }

    static std::string wrong_number(long long i, std::size_t count)
    {
        return "a face names number " + std::to_string(i) + " of " + std::to_string(count) +
               "; numbers start at 1, or at -1 from the end";
    }

    /// Describes the indices of a face that are out of range; empty if there are none.
    std::string beyond(const largest& most, std::size_t count, const std::string& what) const
    {
        if (most.number <= static_cast<long long>(count)) return {};
        return place_of(most.position) + "a face names " + what + ' ' + std::to_string(most.number) +
               ", but there are " + std::to_string(count);
    }

    static void drop_beyond(std::vector<idx>& names, std::size_t count)
    {
        for (idx& i : names) i = i < static_cast<idx>(count) ? i : -1;
    }

    scanner in_;
    polygon_soup soup_;
    largest vertices_, coords_;
    const char* body_ = nullptr;
    bool absolute_ = true;
};

/// Reads the pieces of a large file at the same time. Nothing where that is not possible, or the file is faulty: the
/// place of a fault is known to who reads from the start.
inline std::optional<surface_soup> read_pieces(std::string_view text, const std::string& path, bool strict)
{
    const auto pieces = cut_statements(text, std::max<std::size_t>(text.size() / 32, 1 << 16));
    if (pieces.size() == 1) return std::nullopt;
    std::vector<obj_reader> readers;
    for (const auto piece : pieces)
    {
        // Where a line starts with a byte order mark, it is none.
        if (piece.starts_with('\xef') && piece.data() != text.data()) return std::nullopt;
        readers.emplace_back(piece, path, strict);
    }
    try
    {
        taut::impl::parallel_for(
            readers.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t i = begin; i < end; ++i) readers[i].read();
            },
            0, 1);
    }
    catch (const error&)
    {
        return std::nullopt;
    }
    for (const auto& reader : readers)
        if (!reader.absolute() || reader.faulty()) return std::nullopt;
    obj_reader whole({}, path, strict);
    whole.reserve(readers);
    obj_text found;
    const char* body = nullptr;
    for (std::size_t i = 0; i < readers.size(); ++i)
    {
        found.pieces.push_back({static_cast<std::size_t>(pieces[i].data() - text.data()), whole.corner_count()});
        if (body == nullptr) body = readers[i].body();
        if (!whole.append(std::move(readers[i]))) return std::nullopt;
    }
    if (body == nullptr || !whole.in_range()) return std::nullopt;
    found.body = static_cast<std::size_t>(body - text.data());
    surface_soup file = whole.finish();
    file.obj = std::move(found);
    return file;
}

inline surface_soup read_obj(std::string text, const std::string& path, bool strict)
{
    obj_reader reader(text, path, strict);
    reader.require_text();
    auto file = read_pieces(text, path, strict);
    if (!file)
    {
        reader.read();
        file = reader.finish();
        const char* const body = reader.body();
        file->obj.body = body == nullptr ? text.size() : static_cast<std::size_t>(body - text.data());
        file->obj.pieces = {{0, 0}};
    }
    file->obj.bytes = std::move(text);
    return std::move(*file);
}

/// Reads OBJ text: v, vt and f (with any of v, v/vt, v//vn, v/vt/vn, from 1 or from the end by negative numbers), lines
/// joined by a backslash. All else is kept for write_obj. Polygons are split into triangles, which the notes say.
/// `path` is named in errors. Throws io_error, mesh_error.
inline surface_file parse_obj(std::string text, const std::string& path = "OBJ text")
{
    return to_surface_file(impl::read_obj(std::move(text), path, true), path);
}

/// The same as it is, with the normals that faces name. Throws io_error.
inline surface_soup parse_obj_soup(std::string text, const std::string& path = "OBJ text")
{
    return impl::read_obj(std::move(text), path, false);
}

} // namespace taut::io::impl
