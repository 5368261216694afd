// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/files/surface/obj_statements.hpp>
#include <taut/impl/files/surface/surface_file.hpp>
#include <taut/surface_file.hpp>

/// OBJ text, handed to an Out that has write(std::string_view), such as atomic_file. uv: texture coordinates.
namespace taut::io::impl
{

inline void append_number(std::string& text, idx i)
{
    char digits[16];
    text.append(digits, std::to_chars(digits, std::end(digits), i).ptr);
}

/// A line of a key and numbers, each the shortest decimal that reads back as the value.
inline void append_line(std::string& text, std::string_view key, std::initializer_list<double> values,
                        std::string_view end = "\n")
{
    char line[4 + 6 * 32];
    char* at = std::copy(key.begin(), key.end(), line);
    for (const double x : values)
    {
        *at++ = ' ';
        at = std::to_chars(at, std::end(line), x).ptr;
    }
    text.append(line, at).append(end);
}

/// f v/vt ... or f v/vt/vn ..., counted from 1; the normal of a corner has the number of its vertex. A corner whose
/// texture coordinate is -1 has none.
inline void append_face(std::string& text, std::span<const idx> vertices, std::span<const idx> texcoords, bool normals)
{
    text += 'f';
    for (std::size_t k = 0; k < vertices.size(); ++k)
    {
        char corner[40];
        char* at = corner;
        const auto put = [&](char before, idx number)
        {
            *at++ = before;
            at = std::to_chars(at, at + 12, number + 1).ptr;
        };
        put(' ', vertices[k]);
        if (texcoords[k] >= 0)
            put('/', texcoords[k]);
        else if (normals)
            *at++ = '/';
        if (normals) put('/', vertices[k]);
        text.append(corner, at);
    }
    text += '\n';
}

/// Writes n items one after the other, each as append(text, i) puts it; blocks of them are put in words at the same
/// time, and while those before them are written.
template <class Out, class Append>
void write_items(Out& out, std::size_t n, const Append& append, std::size_t block = 4096)
{
    std::array<std::string, 16> texts, written;
    const auto put = [&](std::size_t b, std::size_t start)
    {
        texts[b].clear();
        for (std::size_t i = start; i < std::min(n, start + block); ++i) append(texts[b], i);
    };
    const auto write = [&]
    {
        for (std::string& text : written) out.write(std::exchange(text, {}));
    };
    for (std::size_t first = 0; first < n; first += block * texts.size())
    {
        const std::size_t blocks = std::min(texts.size(), (n - first + block - 1) / block);
        taut::impl::parallel_for(
            blocks + 1,
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t b = begin; b < end; ++b)
                    if (b == 0)
                        write();
                    else
                        put(b - 1, first + (b - 1) * block);
            },
            0, 3);
        std::swap(texts, written);
    }
    write();
}

template <class Out>
void write_texcoords(Out& out, std::span<const vec2> uv, std::string_view end = "\n")
{
    write_items(out, uv.size(),
                [&](std::string& text, std::size_t i) {
                    append_line(text, "vt", {uv[i].x, uv[i].y}, end);
                });
}

/// The first line end of a text.
inline std::string_view line_end_of(std::string_view text)
{
    const auto at = text.find_first_of("\r\n");
    if (at == text.npos) return "\n";
    return text.substr(at, text.substr(at).starts_with("\r\n") ? 2 : 1);
}

/// Appends statements without those that say vt; corners of faces get the texture coordinates that `texcoord` points
/// at, in their order; -1: none. Corners of lines and free-form surfaces, which have none in a map, get none.
inline void append_rewritten(std::string& out, std::string_view statements, const idx* texcoord)
{
    out.reserve(out.size() + statements.size() + statements.size() / 2);
    scanner in(statements, {});
    const char* copied = statements.data(); // up to here
    const char* const end = copied + statements.size();
    bool dropping = false;
    const auto copy = [&](const char* to)
    {
        if (!dropping) out.append(copied, to);
        copied = to;
        dropping = false;
    };
    for_each_statement(in,
                       [&](std::string_view key, const char* begin)
                       {
                           if (dropping) copy(begin);
                           if (key == "vt")
                           {
                               copy(begin);
                               dropping = true;
                           }
                           else if (is_face(key))
                               while (!in.content_ends())
                               {
                                   const obj_corner corner = read_obj_corner(in);
                                   copy(corner.vertex_end);
                                   const idx t = *texcoord++;
                                   copied = corner.texcoord_end;
                                   if (t >= 0 || (copied != end && *copied == '/')) out += '/';
                                   if (t >= 0) append_number(out, t + 1);
                               }
                           else if (key == "l" || key == "surf")
                               while (!in.content_ends())
                               {
                                   const std::string_view corner = in.word();
                                   const auto slash = corner.find('/');
                                   if (slash == corner.npos) continue;
                                   copy(corner.data() + slash);
                                   const auto normal = corner.find('/', slash + 1);
                                   copied = corner.data() + std::min(normal, corner.size());
                                   if (normal != corner.npos) out += '/';
                               }
                       });
    copy(end);
}

/// An OBJ file byte by byte, but for the vt lines, which stand where the first vt or f stood, and what faces say of
/// them. texcoords: one per corner.
template <class Out>
void write_rewritten(Out& out, const obj_text& obj, std::span<const idx> texcoords, std::span<const vec2> uv)
{
    const std::string_view bytes = obj.bytes;
    out.write(bytes.substr(0, obj.body));
    write_texcoords(out, uv, line_end_of(bytes));
    const auto begin_of = [&](std::size_t piece)
    { return piece < obj.pieces.size() ? std::max(obj.body, obj.pieces[piece].begin) : bytes.size(); };
    write_items(
        out, obj.pieces.size(),
        [&](std::string& text, std::size_t i)
        {
            append_rewritten(text, bytes.substr(begin_of(i), begin_of(i + 1) - begin_of(i)),
                             texcoords.data() + obj.pieces[i].first_corner);
        },
        1);
}

inline std::span<const vec3> points_of(const surface_file& file)
{
    return file.surface.points();
}
inline std::span<const vec3> points_of(const surface_soup& file)
{
    return file.points;
}

/// Writes the content of an OFF or PLY file as OBJ: comments, vertices with their colours, normals, and the faces.
/// texcoords: one per corner, or -1.
template <class Out, class File>
void write_converted(Out& out, const File& file, std::span<const idx> texcoords, std::span<const vec2> uv)
{
    const text_list &positions = file.vertices.positions, &comments = file.vertices.comments;
    const std::vector<vec3>&colours = file.vertices.colours, &normals = file.vertices.normals;
    const auto finite = [](double x) { return std::isfinite(x) ? x : 0.0; };
    write_items(out, comments.size(),
                [&](std::string& text, std::size_t i)
                {
                    text += "# ";
                    std::replace_copy(comments[i].begin(), comments[i].end(), std::back_inserter(text), '\0', ' ');
                    text += '\n';
                });
    const std::span<const vec3> points = points_of(file);
    write_items(out, points.size(),
                [&](std::string& text, std::size_t v)
                {
                    const vec3& p = points[v];
                    if (positions.size() == 0)
                        append_line(text, "v", {p.x, p.y, p.z}, "");
                    else
                        text.append("v ").append(positions[v]);
                    if (!colours.empty())
                        append_line(text, "", {finite(colours[v].x), finite(colours[v].y), finite(colours[v].z)}, "");
                    text += '\n';
                });
    write_items(out, normals.size(),
                [&](std::string& text, std::size_t v) {
                    append_line(text, "vn", {finite(normals[v].x), finite(normals[v].y), finite(normals[v].z)});
                });
    write_texcoords(out, uv);
    const std::span<const idx> corners = file.faces.corners;
    std::vector<std::size_t> first{0};
    first.reserve(file.faces.sizes.size() + 1);
    for (const idx size : file.faces.sizes) first.push_back(first.back() + static_cast<std::size_t>(size));
    write_items(out, file.faces.sizes.size(),
                [&](std::string& text, std::size_t f)
                {
                    const std::size_t size = first[f + 1] - first[f];
                    const auto vertices = corners.subspan(first[f], size);
                    if (size < 3 || std::find(vertices.begin(), vertices.end(), -1) != vertices.end())
                        return; // no face of OBJ
                    append_face(text, vertices, texcoords.subspan(first[f], size), !normals.empty());
                });
}

/// A file of a surface with other texture coordinates. texcoords: one per corner, into uv, or -1.
template <class Out, class File>
void write_with_texcoords(Out& out, const File& file, std::span<const idx> texcoords, std::span<const vec2> uv)
{
    if (file.obj.bytes.empty())
        write_converted(out, file, texcoords, uv);
    else
        write_rewritten(out, file.obj, texcoords, uv);
}

} // namespace taut::io::impl
