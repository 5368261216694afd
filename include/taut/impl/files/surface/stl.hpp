// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <taut/impl/files/file/byte_order.hpp>
#include <taut/impl/files/file/scanner.hpp>
#include <taut/impl/files/surface/point_numbers.hpp>
#include <taut/impl/files/surface/polygon_soup.hpp>

namespace taut::io::impl
{

/// Bytes of a binary STL file: before the triangles, where their number ends, and of each.
constexpr std::size_t stl_header = 84, stl_row = 50;

/// Number of triangles a binary STL file says it has; 0 if it is too short to say.
inline std::size_t stl_triangles(std::string_view bytes)
{
    return bytes.size() < stl_header ? 0 : load<std::uint32_t>(bytes.data() + 80, std::endian::little);
}

/// Returns whether the length is that of a binary STL file, which may begin as a text does. No text has it: the bytes
/// of the number would be letters and stand for half a billion triangles.
inline bool is_binary_stl(std::string_view bytes)
{
    const std::size_t n = stl_triangles(bytes);
    return n > 0 && bytes.size() == stl_header + stl_row * n;
}

/// Reads an STL file, text or binary, into a soup.
class stl_reader
{
public:
    /// strict: faults are thrown, see polygon_soup
    stl_reader(std::string_view bytes, const std::string& path, bool strict) : bytes_(bytes), in_(bytes, path)
    {
        soup_.strict = strict;
    }

    surface_soup read()
    {
        if (!is_binary_stl(bytes_) && is_text())
            read_text();
        else if (bytes_.size() < stl_header)
            throw io_error(
                in_.path(),
                "neither a text nor a binary STL file; name it after the format that it has, or get it whole");
        else
            read_binary();
        const std::size_t corners = soup_.corners.size(), points = soup_.points.size();
        auto file = std::move(soup_).finish();
        file.notes.push_back(std::to_string(corners) + " corners of triangles were welded by position to " +
                             std::to_string(points) + " vertices");
        if (left_over_ > 0)
            file.notes.push_back(std::to_string(left_over_) + " bytes behind the last triangle were left out");
        return file;
    }

private:
    /// Text says "solid", and on a later line "facet" or "endsolid".
    bool is_text() const
    {
        scanner in(bytes_, in_.path());
        in.skip_space();
        if (lower(in.word()) != "solid") return false;
        in.next_line();
        in.skip_space();
        const std::string key = lower(in.word());
        return key == "facet" || key == "endsolid";
    }

    void read_binary()
    {
        const std::size_t triangles = stl_triangles(bytes_);
        if (triangles > (bytes_.size() - stl_header) / stl_row)
            throw io_error(in_.path(),
                           "the file ends too early for " + std::to_string(triangles) +
                               " triangles; correct their number, or get it whole",
                           file_place{file_place::byte, 80});
        soup_.reserve(triangles / 2, 3 * triangles);
        const char* at = bytes_.data() + stl_header;
        for (std::size_t t = 0; t < triangles; ++t, at += stl_row)
        {
            const std::size_t first = soup_.corners.size();
            for (std::size_t k = 0; k < 3; ++k)
            {
                vec3 p;
                for (int i = 0; i < 3; ++i)
                    p[i] = load<float>(at + 12 + 12 * k + 4 * static_cast<std::size_t>(i), std::endian::little);
                add_corner(p, [&] { return in_.byte_of(at); });
            }
            soup_.end_polygon(first, in_.path(), [&] { return in_.byte_of(at); });
        }
        left_over_ = bytes_.size() - stl_header - stl_row * triangles;
    }

    /// One solid or several. What stands for normals is passed over: they follow from the order of the corners.
    void read_text()
    {
        in_.require_text();
        std::size_t first = 0;
        bool inside = false;
        for (in_.skip_space(); !in_.done(); in_.next_line(), in_.skip_space())
        {
            const char* const begin = in_.position();
            const std::string key = lower(in_.word());
            if (key == "outer")
            {
                if (inside) in_.fail("a loop begins in another one; end it with endloop");
                first = soup_.corners.size();
                inside = true;
            }
            else if (key == "vertex")
            {
                if (!inside) in_.fail("a vertex outside of a loop; put 'outer loop' before it");
                add_corner(in_.numbers<3>(), in_.here());
            }
            else if (key == "endloop")
            {
                if (!inside) in_.fail("a loop ends that has not begun; put 'outer loop' before its vertices");
                soup_.end_polygon(first, in_.path(), in_.here());
                inside = false;
            }
            else if (key != "solid" && key != "facet" && key != "endfacet" && key != "endsolid")
            {
                in_.go_to(begin);
                in_.fail_at_word("a statement of STL");
            }
        }
        if (inside) in_.fail("the file ends in a loop; get it whole, or end it with endloop");
    }

    template <class Where>
    void add_corner(const vec3& p, Where where)
    {
        const auto [v, is_new] = numbers_.number(p);
        if (is_new) soup_.add_point(p, in_.path(), where);
        soup_.add_corner(v, in_.path(), where);
    }

    static std::string lower(std::string_view word)
    {
        std::string result(word.substr(0, 16));
        for (char& c : result) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
        return result;
    }

    std::string_view bytes_;
    scanner in_;
    polygon_soup soup_;
    point_numbers numbers_;
    std::size_t left_over_ = 0;
};

/// Reads STL, text or binary, which its length and its first lines tell apart. Corners of equal coordinates are one
/// vertex, numbered in the order in which they first appear, which a note says; triangles keep their order. Normals,
/// names and attributes are left out. `path` is named in errors. Throws io_error, mesh_error.
inline surface_file parse_stl(std::string_view bytes, const std::string& path = "STL file")
{
    return to_surface_file(impl::stl_reader(bytes, path, true).read(), path);
}

/// The same as it is, for repair_surface(). Throws io_error.
inline surface_soup parse_stl_soup(std::string_view bytes, const std::string& path = "STL file")
{
    return impl::stl_reader(bytes, path, false).read();
}

} // namespace taut::io::impl
