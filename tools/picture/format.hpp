// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

/// Numbers and texts for captions and SVG; never by the locale of the user.
namespace taut::io::impl
{

/// 4 significant digits, without trailing zeros: 7.446, 0.0123, 1.5e+12; inf and nan by name.
inline std::string format_number(double x, int digits = 4)
{
    if (std::isnan(x)) return "nan";
    std::array<char, 64> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::general, digits);
    return {text.data(), end.ptr};
}

/// Thousands in groups: 1,500,000.
inline std::string format_count(std::uint64_t n)
{
    const std::string digits = std::to_string(n);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i)
    {
        if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
        text += digits[i];
    }
    return text;
}

/// The number of bytes of the UTF-8 sequence at the front of s, 0 if there is no valid one (RFC 3629, table 3.7 of the
/// Unicode standard: no overlong form, no surrogate, nothing above U+10FFFF).
inline std::size_t utf8_length(std::string_view s)
{
    const auto byte = [s](std::size_t i) { return i < s.size() ? static_cast<unsigned char>(s[i]) : 0; };
    const auto tail = [&](std::size_t i) { return (byte(i) & 0xC0) == 0x80; };
    const int lead = byte(0);
    if (lead < 0x80) return s.empty() ? 0 : 1;
    if (lead >= 0xC2 && lead <= 0xDF) return tail(1) ? 2 : 0;
    if (lead >= 0xE0 && lead <= 0xEF)
    {
        const bool ok = !(lead == 0xE0 && byte(1) < 0xA0) && !(lead == 0xED && byte(1) > 0x9F);
        return ok && tail(1) && tail(2) ? 3 : 0;
    }
    if (lead >= 0xF0 && lead <= 0xF4)
    {
        const bool ok = !(lead == 0xF0 && byte(1) < 0x90) && !(lead == 0xF4 && byte(1) > 0x8F);
        return ok && tail(1) && tail(2) && tail(3) ? 4 : 0;
    }
    return 0;
}

/// Text as the content of an XML element: markup escaped; what XML 1.0 cannot hold (control characters, broken UTF-8)
/// becomes '?'.
inline std::string escape_xml(std::string_view text)
{
    std::string out;
    while (!text.empty())
    {
        const std::size_t n = utf8_length(text);
        const std::string_view c = text.substr(0, n > 0 ? n : 1);
        if (c == "&")
            out += "&amp;";
        else if (c == "<")
            out += "&lt;";
        else if (c == ">")
            out += "&gt;";
        else if (n == 0 || (n == 1 && static_cast<unsigned char>(c[0]) < 32) || c == "\x7F" || c == "\xEF\xBF\xBE" ||
                 c == "\xEF\xBF\xBF")
            out += '?';
        else
            out += c;
        text.remove_prefix(c.size());
    }
    return out;
}

} // namespace taut::io::impl
