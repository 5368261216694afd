// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace taut::io::impl
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

/// The characters that base64 makes of n bytes, = at the end included.
constexpr std::size_t base64_length(std::size_t n)
{
    return (n + 2) / 3 * 4;
}

} // namespace taut::io::impl
