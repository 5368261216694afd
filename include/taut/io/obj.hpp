// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/core/parallel.hpp>
#include <taut/io/polygon_soup.hpp>
#include <taut/io/scanner.hpp>

namespace taut::io
{
namespace detail
{

/// Reads OBJ statements into a soup. A reader of a piece of a file takes in those of the following pieces.
class obj_reader
{
public:
    obj_reader(std::string_view text, const std::string& path) : in_(text, path) {}

    void require_text() const { in_.require_text(); }

    void read()
    {
        // What a file of triangles has, about; memory that is not used costs nothing.
        soup_.reserve(in_.remaining() / 64, in_.remaining() / 10);
        while (!in_.done())
        {
            const std::string_view key = in_.word();
            if (key.size() == 1 && key[0] == 'v')
            {
                soup_.add_point(in_.numbers<3>(), in_.path(), in_.here());
                if (!in_.line_ends()) read_extra();
            }
            else if (key.size() == 1 && key[0] == 'f')
                read_face();
            else if (key == "vt")
            {
                const double u = in_.number();
                // A texture of one dimension has no v.
                soup_.add_texcoord({u, in_.line_ends() ? 0.0 : in_.number()}, in_.path(), in_.here());
            }
            // Comments end with their line; every other statement may be joined to the next line.
            in_.next_line(!key.starts_with('#'));
        }
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

    /// Whether the faces name only what there is.
    bool in_range() const
    {
        const auto within = [](const largest& most, std::size_t count)
        { return most.number <= static_cast<long long>(count); };
        return within(vertices_, soup_.points.size()) && within(coords_, soup_.texcoords.size());
    }

    surface_file finish()
    {
        require_range(vertices_, soup_.points.size(), "vertex");
        require_range(coords_, soup_.texcoords.size(), "texture coordinate");
        return std::move(soup_).finish(in_.path());
    }

private:
    /// The largest number that a face names, where, and by which face: the vertices may follow later in the file.
    struct largest
    {
        long long number = 0;
        const char* position = nullptr;
        std::size_t face = 0;
    };

    /// What a v line holds behind the position: a weight or a colour, kept as it is written.
    void read_extra()
    {
        std::string extra;
        while (!in_.line_ends() && !in_.at('#')) extra.append(extra.empty() ? "" : " ").append(in_.word());
        if (extra.empty()) return;
        soup_.extras.resize(soup_.points.size());
        soup_.extras.back() = std::move(extra);
    }

    void read_face()
    {
        const std::size_t first = soup_.corners.size();
        while (!in_.line_ends()) read_corner();
        soup_.end_polygon(first, in_.path(), in_.here());
    }

    /// v, v/vt, v//vn or v/vt/vn. The normal is not used.
    void read_corner()
    {
        soup_.corners.push_back(read_reference(soup_.points.size(), vertices_));
        index coord = -1;
        if (in_.take('/'))
        {
            if (!in_.at('/') && !in_.word_ends()) coord = read_reference(soup_.texcoords.size(), coords_);
            if (in_.take('/') && !in_.word_ends()) in_.integer("a normal");
        }
        if (!in_.word_ends()) in_.fail_at_word("a blank after the corner of a face");
        soup_.corner_coords.push_back(coord);
    }

    /// A number counted from 1, or back from -1, the last of `count`. The result is counted from 0.
    index read_reference(std::size_t count, largest& most)
    {
        const char* position = in_.position();
        const long long i = in_.integer("a corner such as 7, 7/7 or 7//7");
        absolute_ = absolute_ && i > 0;
        const long long zero_based = i > 0 ? i - 1 : static_cast<long long>(count) + i;
        if (i == 0 || zero_based < 0 || zero_based > static_cast<long long>(polygon_soup::limit))
            in_.fail("a face names number " + std::to_string(i) + " of " + std::to_string(count) +
                     "; numbers start at 1, or at -1 from the end");
        if (zero_based >= most.number) most = {zero_based + 1, position, soup_.sizes.size()};
        return static_cast<index>(zero_based);
    }

    void require_range(const largest& most, std::size_t count, const std::string& what) const
    {
        if (most.number > static_cast<long long>(count))
            throw mesh_error(mesh_fault::index_out_of_range,
                             {static_cast<index>(most.face), static_cast<index>(most.number - 1)},
                             place_prefix(in_.path(), in_.line_of(most.position)) + "a face names " + what + ' ' +
                                 std::to_string(most.number) + ", but there are " + std::to_string(count));
    }

    scanner in_;
    polygon_soup soup_;
    largest vertices_, coords_;
    bool absolute_ = true;
};

/// The text in pieces of about `size` bytes that end with a statement.
inline std::vector<std::string_view> cut_statements(std::string_view text, std::size_t size)
{
    std::vector<std::string_view> pieces;
    std::size_t begin = 0;
    while (text.size() - begin > size)
    {
        std::size_t end = begin + size;
        const auto joined = [&]
        {
            const std::size_t last = text[end - 1] == '\r' ? end - 2 : end - 1;
            return text[last] == '\\';
        };
        do end = text.find('\n', end + 1);
        while (end != text.npos && joined());
        if (end == text.npos) break;
        pieces.push_back(text.substr(begin, end + 1 - begin));
        begin = end + 1;
    }
    pieces.push_back(text.substr(begin));
    return pieces;
}

/// Reads the pieces of a large file at the same time. Nothing where that is not possible, or the file is faulty: the
/// place of a fault is known to who reads from the start.
inline std::optional<surface_file> read_pieces(std::string_view text, const std::string& path)
{
    const auto pieces = cut_statements(text, std::max<std::size_t>(text.size() / 32, 1 << 16));
    if (pieces.size() == 1) return std::nullopt;
    std::vector<obj_reader> readers;
    for (const auto piece : pieces)
    {
        // Where a line starts with a byte order mark, it is none.
        if (piece.starts_with('\xef') && piece.data() != text.data()) return std::nullopt;
        readers.emplace_back(piece, path);
    }
    try
    {
        parallel_for(
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
        if (!reader.absolute()) return std::nullopt;
    obj_reader whole({}, path);
    whole.reserve(readers);
    for (auto& reader : readers)
        if (!whole.append(std::move(reader))) return std::nullopt;
    if (!whole.in_range()) return std::nullopt;
    return whole.finish();
}

} // namespace detail

/// Reads OBJ text: v, vt and f (with any of v, v/vt, v//vn, v/vt/vn, from 1 or from the end by negative numbers), lines
/// joined by a backslash. All else is skipped. Polygons are split into triangles, which the notes say. `path` is named
/// in errors. Throws io_error, mesh_error.
inline surface_file parse_obj(std::string_view text, const std::string& path = "OBJ text")
{
    detail::obj_reader reader(text, path);
    reader.require_text();
    if (auto file = detail::read_pieces(text, path)) return std::move(*file);
    reader.read();
    return reader.finish();
}

} // namespace taut::io
