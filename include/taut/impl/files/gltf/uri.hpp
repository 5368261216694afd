// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <taut/impl/files/volume/coding/base64.hpp>

/// URIs as glTF has them: data in base64, or files relative to the document.
namespace taut::io::impl
{

inline bool is_data_uri(std::string_view uri)
{
    return uri.starts_with("data:");
}

/// Returns whether a URI begins with a scheme such as data: or https:, and thus names no file beside the document.
inline bool has_scheme(std::string_view uri)
{
    const auto end = uri.find_first_of(":/?#");
    return end != uri.npos && uri[end] == ':';
}

/// %20 and the like as the bytes they stand for.
inline std::string percent_decoded(std::string_view uri)
{
    const auto digit = [](char c)
    {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i)
    {
        const bool escaped = uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
        text += escaped ? static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2])) : uri[i];
        if (escaped) i += 2;
    }
    return text;
}

/// A path of a file as a URI.
inline std::string percent_encoded(std::string_view path)
{
    constexpr std::string_view plain = "-._~/", hex = "0123456789ABCDEF";
    std::string uri;
    for (const char c : path)
    {
        const auto byte = static_cast<unsigned char>(c);
        if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || plain.find(c) != plain.npos)
            uri += c;
        else
            (uri += '%').append({hex[byte >> 4], hex[byte & 15]});
    }
    return uri;
}

} // namespace taut::io::impl
