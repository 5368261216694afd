// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>

#include <taut/impl/files/surface/stl.hpp>
#include <taut/surface_file.hpp>

namespace taut::io::impl
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

} // namespace taut::io::impl
