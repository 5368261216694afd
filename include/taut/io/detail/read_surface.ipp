// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <taut/io/obj.hpp>
#include <taut/io/off.hpp>
#include <taut/io/ply.hpp>
#include <taut/io/read_file.hpp>
#include <taut/io/read_surface.hpp>
#include <taut/io/stl.hpp>
#include <utility>

namespace taut::io
{

namespace detail
{

/// By the extension; automatic if that is none of ours.
inline surface_format format_of_name(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    return extension == ".obj"   ? surface_format::obj
           : extension == ".off" ? surface_format::off
           : extension == ".ply" ? surface_format::ply
           : extension == ".stl" ? surface_format::stl
                                 : surface_format::automatic;
}

/// By the first word: PLY begins with one, text STL, too, OFF with a word that ends in OFF or with a number.
inline surface_format format_of_text(std::string_view text)
{
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    if (text.starts_with("ply")) return surface_format::ply;
    if (is_binary_stl(text)) return surface_format::stl;
    constexpr std::string_view space = " \t\r\n";
    for (;;)
    {
        text.remove_prefix(std::min(text.find_first_not_of(space), text.size()));
        if (!text.starts_with('#')) break;
        text.remove_prefix(std::min(text.find_first_of("\r\n"), text.size()));
    }
    const auto word = text.substr(0, text.find_first_of(space));
    const bool number = !word.empty() && word[0] >= '0' && word[0] <= '9';
    return number || word.ends_with("OFF") ? surface_format::off
           : word == "solid"               ? surface_format::stl
                                           : surface_format::obj;
}

/// A device, a pipe or standard input: its name says nothing of what is in it.
inline bool is_stream_to_read(const std::filesystem::path& path)
{
    std::error_code unknown;
    return open_file_number(path) >= 0 ||
           (std::filesystem::exists(path, unknown) && !std::filesystem::is_regular_file(path, unknown) &&
            !std::filesystem::is_directory(path, unknown));
}

/// All bytes of a file, and the format made known.
inline std::string read_surface_bytes(const std::filesystem::path& path, surface_format& format)
{
    if (format == surface_format::automatic) format = format_of_name(path);
    if (format == surface_format::automatic && !is_stream_to_read(path))
        throw io_error(path.string(), "unknown kind of file; surfaces are read from .obj, .off, .ply and .stl, from "
                                      "other names if the format is given");
    std::string text = read_file(path);
    if (!is_binary_stl(text)) refuse_utf16(text, path.string());
    if (format == surface_format::automatic) format = format_of_text(text);
    return text;
}

} // namespace detail

surface_file read_surface_file(const std::filesystem::path& path, surface_format format)
{
    const std::string name = path.string();
    std::string text = detail::read_surface_bytes(path, format);
    return format == surface_format::off   ? parse_off(text, name)
           : format == surface_format::ply ? parse_ply(text, name)
           : format == surface_format::stl ? parse_stl(text, name)
                                           : parse_obj(std::move(text), name);
}

surface_soup read_surface_soup(const std::filesystem::path& path, surface_format format)
{
    const std::string name = path.string();
    std::string text = detail::read_surface_bytes(path, format);
    return format == surface_format::off   ? parse_off_soup(text, name)
           : format == surface_format::ply ? parse_ply_soup(text, name)
           : format == surface_format::stl ? parse_stl_soup(text, name)
                                           : parse_obj_soup(std::move(text), name);
}

mesh<triangle> read_surface(const std::filesystem::path& path, surface_format format)
{
    return read_surface_file(path, format).surface;
}

} // namespace taut::io
