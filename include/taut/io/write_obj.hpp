// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>

#include <taut/io/atomic_file.hpp>
#include <taut/mesh/mesh.hpp>

namespace taut::io
{
namespace detail
{

/// Appends the shortest decimal number that reads back as x.
template <class Number>
void append_number(std::string& text, Number x)
{
    char digits[32];
    const auto result = std::to_chars(digits, digits + sizeof digits, x);
    text.append(digits, result.ptr);
}

inline void append_line(std::string& text, const char* key, std::initializer_list<double> values)
{
    text += key;
    for (const double x : values)
    {
        text += ' ';
        append_number(text, x);
    }
    text += '\n';
}

} // namespace detail

/// Writes a surface and a map of it to the plane as OBJ: the vertices in their order with values that read back bit
/// for bit, one vt a vertex, faces v/vt. The file appears complete or not at all.
/// uv: one a vertex. extras: surface_file::extras, further text for the v lines; may be shorter than the vertices.
/// Throws io_error; parameter_error if uv has another size.
inline void write_obj(const std::filesystem::path& path, const mesh<triangle>& surface, std::span<const vec2> uv,
                      std::span<const std::string> extras = {})
{
    if (uv.size() != surface.points().size())
        throw parameter_error("uv", std::to_string(uv.size()) + " texture coordinates for " +
                                        std::to_string(surface.points().size()) + " vertices; give one a vertex");
    constexpr std::size_t block = 1 << 18;
    atomic_file file(path);
    std::string text;
    text.reserve(block + 256);
    const auto flush = [&](std::size_t above)
    {
        if (text.size() <= above) return;
        file.write(text);
        text.clear();
    };
    for (std::size_t v = 0; v < uv.size(); ++v)
    {
        const vec3& p = surface.points()[v];
        detail::append_line(text, "v", {p.x, p.y, p.z});
        if (v < extras.size() && !extras[v].empty()) text.insert(text.size() - 1, ' ' + extras[v]);
        flush(block);
    }
    for (const vec2& x : uv)
    {
        detail::append_line(text, "vt", {x.x, x.y});
        flush(block);
    }
    for (const auto& t : surface.cells())
    {
        text += 'f';
        for (const index v : t)
        {
            const std::size_t start = text.size() + 1;
            text += ' ';
            detail::append_number(text, static_cast<long long>(v) + 1);
            const std::size_t length = text.size() - start;
            text += '/';
            text.append(text, start, length);
        }
        text += '\n';
        flush(block);
    }
    flush(0);
    file.commit();
}

} // namespace taut::io
