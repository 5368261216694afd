// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <iterator>
#include <span>
#include <string>
#include <string_view>

#include <taut/core/parallel.hpp>
#include <taut/io/atomic_file.hpp>
#include <taut/mesh/mesh.hpp>

namespace taut::io
{
namespace detail
{

/// A line of a key and numbers, each the shortest decimal that reads back as the value.
inline void append_line(std::string& text, std::string_view key, std::initializer_list<double> values)
{
    char line[4 + 3 * 32];
    char* at = std::copy(key.begin(), key.end(), line);
    for (const double x : values)
    {
        *at++ = ' ';
        at = std::to_chars(at, std::end(line), x).ptr;
    }
    *at++ = '\n';
    text.append(line, at);
}

/// f v/vt v/vt v/vt, where both numbers are one: counted from 1.
inline void append_face(std::string& text, const std::array<index, 3>& face)
{
    char line[128];
    char* at = line;
    *at++ = 'f';
    for (const index v : face)
    {
        *at++ = ' ';
        char number[16];
        char* const end = std::to_chars(number, std::end(number), static_cast<long long>(v) + 1).ptr;
        at = std::copy_n(number, end - number, at);
        *at++ = '/';
        at = std::copy_n(number, end - number, at);
    }
    *at++ = '\n';
    text.append(line, at);
}

/// Writes n items one after the other, each as append(text, i) puts it; blocks of them are put in words at the same
/// time.
template <class Append>
void write_items(atomic_file& file, std::size_t n, const Append& append)
{
    constexpr std::size_t block = 4096;
    std::array<std::string, 16> texts;
    for (std::size_t first = 0; first < n; first += block * texts.size())
    {
        const std::size_t blocks = std::min(texts.size(), (n - first + block - 1) / block);
        parallel_for(
            blocks,
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t b = begin; b < end; ++b)
                {
                    texts[b].clear();
                    const std::size_t start = first + b * block;
                    for (std::size_t i = start; i < std::min(n, start + block); ++i) append(texts[b], i);
                }
            },
            0, 2);
        for (std::size_t b = 0; b < blocks; ++b) file.write(texts[b]);
    }
}

} // namespace detail

/// Writes a surface and a map of it to the plane as OBJ: the vertices in their order with values that read back bit
/// for bit, one vt a vertex, faces v/vt.
/// uv: one a vertex. extras: surface_file::extras, further text for the v lines; may be shorter than the vertices.
/// Throws io_error; parameter_error if uv has another size.
inline void write_obj(atomic_file& file, const mesh<triangle>& surface, std::span<const vec2> uv,
                      std::span<const std::string> extras = {})
{
    if (uv.size() != surface.points().size())
        throw parameter_error("uv", std::to_string(uv.size()) + " texture coordinates for " +
                                        std::to_string(surface.points().size()) + " vertices; give one a vertex");
    detail::write_items(file, uv.size(),
                        [&](std::string& text, std::size_t v)
                        {
                            const vec3& p = surface.points()[v];
                            detail::append_line(text, "v", {p.x, p.y, p.z});
                            if (v < extras.size() && !extras[v].empty()) text.insert(text.size() - 1, ' ' + extras[v]);
                        });
    detail::write_items(file, uv.size(),
                        [&](std::string& text, std::size_t v) {
                            detail::append_line(text, "vt", {uv[v].x, uv[v].y});
                        });
    detail::write_items(file, surface.cells().size(),
                        [&](std::string& text, std::size_t c) { detail::append_face(text, surface.cells()[c]); });
}

/// The same to a file that appears complete or not at all.
inline void write_obj(const std::filesystem::path& path, const mesh<triangle>& surface, std::span<const vec2> uv,
                      std::span<const std::string> extras = {})
{
    atomic_file file(path);
    write_obj(file, surface, uv, extras);
    file.commit();
}

} // namespace taut::io
