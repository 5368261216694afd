// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include <taut/impl/files/file/read_file.hpp>
#include <taut/impl/files/surface/obj.hpp>
#include <taut/impl/files/surface/off.hpp>
#include <taut/impl/files/surface/ply.hpp>
#include <taut/impl/files/surface/stl.hpp>
#include <taut/impl/files/surface/surface_formats.hpp>
#include <taut/impl/files/volume/formats.hpp>
#include <taut/surface_file.hpp>

namespace taut::io::impl
{

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
        refuse_kind(path, "surfaces are read from .obj, .off, .ply and .stl");
    std::string text = read_file(path);
    if (!is_binary_stl(text)) refuse_utf16(text, path.string());
    if (format == surface_format::automatic) format = format_of_text(text);
    return text;
}

} // namespace taut::io::impl

namespace taut::io
{

surface_file read_surface_file(const std::filesystem::path& path, surface_format format)
{
    const std::string name = path.string();
    std::string text = impl::read_surface_bytes(path, format);
    return format == surface_format::off   ? impl::parse_off(text, name)
           : format == surface_format::ply ? impl::parse_ply(text, name)
           : format == surface_format::stl ? impl::parse_stl(text, name)
                                           : impl::parse_obj(std::move(text), name);
}

surface_soup read_surface_soup(const std::filesystem::path& path, surface_format format)
{
    const std::string name = path.string();
    std::string text = impl::read_surface_bytes(path, format);
    return format == surface_format::off   ? impl::parse_off_soup(text, name)
           : format == surface_format::ply ? impl::parse_ply_soup(text, name)
           : format == surface_format::stl ? impl::parse_stl_soup(text, name)
                                           : impl::parse_obj_soup(std::move(text), name);
}

mesh<triangle> read_surface(const std::filesystem::path& path, surface_format format)
{
    return read_surface_file(path, format).surface;
}

} // namespace taut::io
