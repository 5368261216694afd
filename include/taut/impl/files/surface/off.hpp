// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/files/file/scanner.hpp>
#include <taut/impl/files/surface/polygon_soup.hpp>

namespace taut::io::impl
{

/// Reads OFF text into a soup.
class off_reader
{
public:
    off_reader(std::string_view text, const std::string& path, bool strict) : in_(text, path, true)
    {
        refuse_binary();
        in_.require_text();
        soup_.strict = strict;
    }

    polygon_soup read()
    {
        read_header();
        const std::size_t vertices = read_count("the number of vertices"), faces = read_count("the number of faces");
        // The number of edges is often wrong and never needed; it may be missing.
        end_line();
        // The shortest vertex is "0 0 0\n". A count beyond the file is refused before memory is asked for.
        if (vertices > in_.remaining() / 5 || faces > in_.remaining() / 5)
            in_.fail("the file ends too early; correct its counts, or get it whole");
        soup_.points.reserve(vertices);
        soup_.sizes.reserve(faces);
        soup_.corners.reserve(3 * faces);
        for (std::size_t v = 0; v < vertices; ++v) read_vertex();
        for (std::size_t f = 0; f < faces; ++f) read_face();
        if (has_texcoords_) soup_.corner_coords = soup_.corners;
        scale_colours();
        return std::move(soup_);
    }

private:
    static bool ends_in_off(std::string_view word)
    {
        return word.size() >= 3 && same_letters(word.substr(word.size() - 3), "OFF");
    }

    /// Geomview's binary form says so behind the header.
    void refuse_binary() const
    {
        scanner in = in_;
        if (ends_in_off(in.word()) && same_letters(in.word(), "BINARY"))
            in.fail("binary OFF is not read; save it as text");
    }

    /// [ST][C][N]OFF, or nothing: the header may be missing.
    void read_header()
    {
        skip_to_content();
        if (in_.at_digit()) return;
        const std::string_view key = in_.word();
        std::string_view kind = ends_in_off(key) ? key.substr(0, key.size() - 3) : "?";
        const auto take = [&kind](std::string_view letters)
        {
            if (!same_letters(kind.substr(0, letters.size()), letters)) return false;
            kind.remove_prefix(letters.size());
            return true;
        };
        has_texcoords_ = take("ST");
        has_colours_ = take("C");
        has_normals_ = take("N");
        if (!kind.empty())
            in_.fail("not an OFF file of points in space: '" + std::string(key.substr(0, 40)) +
                     "'; save it as OFF, COFF, NOFF or STOFF");
        skip_to_content();
        if (!in_.at_digit()) in_.fail_at_word("the number of vertices");
    }

    std::size_t read_count(const char* what)
    {
        skip_to_content();
        const long long n = in_.integer(what);
        if (n < 0) in_.fail(std::string(what) + " is negative; count from 0");
        return static_cast<std::size_t>(n);
    }

    /// Goes to the next number or word, past empty lines and comments.
    void skip_to_content()
    {
        while (in_.content_ends() && !in_.done()) end_line();
    }

    /// Goes to the next line. A comment is kept.
    void end_line()
    {
        while (!in_.content_ends()) in_.word();
        if (in_.take('#')) soup_.carried.comments.add(in_.rest_of_line());
        in_.next_line();
    }

    /// x y z, then the normal, the colour with or without its opacity, and s t, as the header says.
    void read_vertex()
    {
        skip_to_content();
        auto& carried = soup_.carried;
        vec3 p;
        for (int k = 0; k < 3; ++k)
        {
            in_.skip_blanks();
            const char* const begin = in_.position();
            p[k] = in_.number();
            if (k > 0) carried.positions.append(" ");
            append_written(carried.positions, in_.since(begin));
        }
        carried.positions.end();
        soup_.add_point(p, in_.path(), in_.here());
        if (has_normals_ || has_colours_ || has_texcoords_) read_attributes();
        end_line();
    }

    void read_attributes()
    {
        values_.clear();
        while (!in_.content_ends()) values_.push_back(in_.number());
        const std::size_t normal = has_normals_ ? 3 : 0, colour = has_colours_ ? 3 : 0, coords = has_texcoords_ ? 2 : 0;
        if (values_.size() < normal + colour + coords)
            in_.fail("expected " + std::to_string(normal + colour + coords) +
                     " numbers behind the position of a vertex, which the header says has" +
                     (has_normals_ ? " a normal" : "") + (has_colours_ ? " a colour" : "") +
                     (has_texcoords_ ? " texture coordinates" : ""));
        const auto three = [this](std::size_t i) { return vec3(values_[i], values_[i + 1], values_[i + 2]); };
        if (has_normals_) soup_.carried.normals.push_back(three(0));
        if (has_colours_) soup_.carried.colours.push_back(three(normal));
        if (has_texcoords_) soup_.add_texcoord({values_[values_.size() - 2], values_.back()}, in_.path(), in_.here());
    }

    /// Colours from 0 to 255 are as common as those from 0 to 1.
    void scale_colours()
    {
        auto& colours = soup_.carried.colours;
        const auto beyond = [](const vec3& c) { return c.x > 1 || c.y > 1 || c.z > 1; };
        if (std::any_of(colours.begin(), colours.end(), beyond))
            for (vec3& c : colours) c /= 255.0;
    }

    /// n, then n vertices, then perhaps a colour.
    void read_face()
    {
        skip_to_content();
        const std::size_t first = soup_.corners.size();
        for (long long n = in_.integer("the number of corners of a face"); n > 0; --n)
        {
            skip_to_content();
            soup_.add_corner(in_.integer("a vertex number"), in_.path(), in_.here());
        }
        soup_.end_polygon(first, in_.path(), in_.here());
        end_line();
    }

    scanner in_;
    polygon_soup soup_;
    std::vector<double> values_; // of a vertex, behind its position
    bool has_texcoords_ = false, has_colours_ = false, has_normals_ = false;
};

/// Reads OFF text: OFF, COFF, NOFF, STOFF and their combinations, one vertex per line, with comments, and with the
/// counts beside or below the header. Normals, colours and comments are kept for write_obj. Polygons are split into
/// triangles, which the notes say. `path` is named in errors. Throws io_error, mesh_error.
inline surface_file parse_off(std::string_view text, const std::string& path = "OFF text")
{
    return impl::off_reader(text, path, true).read().finish(path);
}

/// The same as it is. Throws io_error.
inline surface_soup parse_off_soup(std::string_view text, const std::string& path = "OFF text")
{
    return impl::off_reader(text, path, false).read().finish();
}

} // namespace taut::io::impl
