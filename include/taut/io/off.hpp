// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include <taut/io/polygon_soup.hpp>
#include <taut/io/scanner.hpp>

namespace taut::io
{
namespace detail
{

/// Reads OFF text into a soup.
class off_reader
{
public:
    off_reader(std::string_view text, const std::string& path) : in_(text, path) { in_.require_text(); }

    surface_file read()
    {
        read_header();
        const std::size_t vertices = read_count("the number of vertices"), faces = read_count("the number of faces");
        // The number of edges is often wrong and never needed; it may be missing.
        in_.next_line();
        // The shortest vertex is "0 0 0\n". A count beyond the file is refused before memory is asked for.
        if (vertices > in_.remaining() / 5 || faces > in_.remaining() / 5) in_.fail("the file ends too early");
        soup_.points.reserve(vertices);
        soup_.sizes.reserve(faces);
        soup_.corners.reserve(3 * faces);
        for (std::size_t v = 0; v < vertices; ++v) read_vertex();
        for (std::size_t f = 0; f < faces; ++f) read_face();
        if (has_texcoords_) soup_.corner_coords = soup_.corners;
        return std::move(soup_).finish(in_.path());
    }

private:
    /// [ST][C][N]OFF, or nothing: the header may be missing.
    void read_header()
    {
        in_.skip_space_and_comments();
        if (in_.at_digit()) return;
        const std::string_view key = in_.word();
        const std::string_view kind = key.ends_with("OFF") ? key.substr(0, key.size() - 3) : "?";
        has_texcoords_ = kind.starts_with("ST");
        const std::string_view rest = has_texcoords_ ? kind.substr(2) : kind;
        if (!rest.empty() && rest != "C" && rest != "N" && rest != "CN")
            in_.fail("not an OFF file of points in space: '" + std::string(key.substr(0, 40)) + "'");
        in_.skip_space_and_comments();
        if (!in_.at_digit()) in_.fail("expected the number of vertices; binary OFF is not supported");
    }

    std::size_t read_count(const char* what)
    {
        in_.skip_space_and_comments();
        const long long n = in_.integer(what);
        if (n < 0) in_.fail(std::string(what) + " is negative");
        return static_cast<std::size_t>(n);
    }

    /// x y z, then normal and colour, then s t at the end of the line.
    void read_vertex()
    {
        in_.skip_space_and_comments();
        soup_.add_point(in_.numbers<3>(), in_.path(), in_.here());
        if (has_texcoords_)
        {
            vec2 last(0.0);
            int more = 0;
            for (; !in_.line_ends() && !in_.at('#'); ++more) last = {last.y, in_.number()};
            if (more < 2) in_.fail("expected the texture coordinates of the vertex");
            soup_.add_texcoord(last, in_.path(), in_.here());
        }
        in_.next_line();
    }

    /// n, then n vertices, then perhaps a colour.
    void read_face()
    {
        in_.skip_space_and_comments();
        const std::size_t first = soup_.corners.size();
        for (long long n = in_.integer("the number of corners of a face"); n > 0; --n)
        {
            in_.skip_space_and_comments();
            soup_.add_corner(in_.integer("a vertex number"), in_.path(), in_.here());
        }
        soup_.end_polygon(first, in_.path(), in_.here());
        in_.next_line();
    }

    scanner in_;
    polygon_soup soup_;
    bool has_texcoords_ = false;
};

} // namespace detail

/// Reads OFF text: OFF, COFF, NOFF, STOFF and their combinations, one vertex a line, with comments, and with the counts
/// beside or below the header. Normals and colours are skipped. Polygons are split into triangles, which the notes
/// say. `path` is named in errors. Throws io_error, mesh_error.
inline surface_file parse_off(std::string_view text, const std::string& path = "OFF text")
{
    return detail::off_reader(text, path).read();
}

} // namespace taut::io
