// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <taut/io/polygon_soup.hpp>
#include <taut/io/scanner.hpp>

namespace taut::io
{
namespace detail
{

/// Reads OBJ statements into a soup.
class obj_reader
{
public:
    obj_reader(std::string_view text, const std::string& path) : in_(text, path) { in_.require_text(); }

    surface_file read()
    {
        while (!in_.done())
        {
            const std::string_view key = in_.word();
            if (key == "v")
            {
                soup_.add_point(in_.numbers<3>(), in_.path(), in_.here());
                if (!in_.line_ends()) read_extra();
            }
            else if (key == "vt")
            {
                const double u = in_.number();
                // A texture of one dimension has no v.
                soup_.add_texcoord({u, in_.line_ends() ? 0.0 : in_.number()}, in_.path(), in_.here());
            }
            else if (key == "f")
                read_face();
            // Comments end with their line; every other statement may be joined to the next line.
            in_.next_line(!key.starts_with('#'));
        }
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
};

} // namespace detail

/// Reads OBJ text: v, vt and f (with any of v, v/vt, v//vn, v/vt/vn, from 1 or from the end by negative numbers), lines
/// joined by a backslash. All else is skipped. Polygons are split into triangles, which the notes say. `path` is named
/// in errors. Throws io_error, mesh_error.
inline surface_file parse_obj(std::string_view text, const std::string& path = "OBJ text")
{
    return detail::obj_reader(text, path).read();
}

} // namespace taut::io
