// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// URIs as glTF has them: data in base64, or files relative to the document.
namespace taut::io::detail
{

constexpr std::string_view base64_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

inline std::string to_base64(std::string_view bytes)
{
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3)
    {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : base64_digits[three >> (18 - 6 * k) & 63];
    }
    return text;
}

/// Nothing if it is no base64.
inline std::optional<std::string> from_base64(std::string_view text)
{
    static constexpr auto values = []
    {
        std::array<int, 256> v{};
        v.fill(-1);
        for (std::size_t i = 0; i < 64; ++i) v[static_cast<unsigned char>(base64_digits[i])] = static_cast<int>(i);
        return v;
    }();
    while (text.ends_with('=')) text.remove_suffix(1);
    if (text.size() % 4 == 1) return {};
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t held = 0;
    int bits = 0;
    for (const char c : text)
    {
        const int value = values[static_cast<unsigned char>(c)];
        if (value < 0) return {};
        held = held << 6 | static_cast<std::uint32_t>(value);
        if ((bits += 6) < 8) continue;
        bits -= 8;
        bytes += static_cast<char>(held >> bits & 255);
    }
    return bytes;
}

inline bool is_data_uri(std::string_view uri)
{
    return uri.starts_with("data:");
}

/// Whether a URI begins with a scheme such as data: or https:, and thus names no file beside the document.
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

} // namespace taut::io::detail
