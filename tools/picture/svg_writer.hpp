// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <picture/color.hpp>
#include <picture/format.hpp>

namespace taut::io::impl
{

/// Collects the text of an SVG document. Face coordinates are whole tenths of a pixel, in relative path commands:
/// short.
class svg_writer
{
public:
    svg_writer(int width, int height, rgb ground = {255, 255, 255})
    {
        const std::string w = std::to_string(width), h = std::to_string(height);
        text_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "\" height=\"" + h + "\" viewBox=\"0 0 " +
                w + " " + h + "\" font-family=\"Helvetica, Arial, sans-serif\">\n";
        rectangle({0, 0}, vec2(width, height), ground);
    }

    void raw(std::string_view s) { text_ += s; }

    static std::string hex(rgb c)
    {
        constexpr std::string_view digits = "0123456789abcdef";
        std::string s = "#";
        for (const int byte : {c.r, c.g, c.b})
            (s += digits[static_cast<std::size_t>(byte / 16)]) += digits[static_cast<std::size_t>(byte % 16)];
        return s;
    }

    void rectangle(const vec2& a, const vec2& b, rgb color) { rectangle(a, b, hex(color)); }

    /// paint: a colour or the url of a gradient.
    void rectangle(const vec2& a, const vec2& b, const std::string& paint)
    {
        text_ += "<rect x=\"" + pixels(a.x) + "\" y=\"" + pixels(std::min(a.y, b.y)) + "\" width=\"" +
                 pixels(b.x - a.x) + "\" height=\"" + pixels(std::abs(b.y - a.y)) + "\" fill=\"" + paint + "\"/>\n";
    }

    void words(const vec2& at, std::string_view s, double size, rgb color, bool bold = false)
    {
        if (s.empty()) return;
        text_ += "<text x=\"" + pixels(at.x) + "\" y=\"" + pixels(at.y) + "\" font-size=\"" + pixels(size) +
                 "\" fill=\"" + hex(color) + (bold ? "\" font-weight=\"bold\">" : "\">") + escape_xml(s) + "</text>\n";
    }

    /// A path in tenths of a pixel; `attributes` say how it looks. Subpaths follow with move().
    void begin_path(const std::string& attributes)
    {
        text_ += "<path transform=\"scale(.1)\" " + attributes + " d=\"";
        pen_ = {0, 0};
    }

    void move(const vec2& p) { go('m', p); }
    void line(const vec2& p) { go('l', p); }

    /// Ends the triangle that began at `start`: the pen returns there.
    void close(const vec2& start)
    {
        text_ += 'z';
        pen_ = tenths(start);
    }

    void end_path() { text_ += "\"/>\n"; }

    std::string finish()
    {
        text_ += "</svg>\n";
        return std::move(text_);
    }

    static std::string pixels(double x) { return format_number(std::round(x * 100) / 100, 7); }

    /// True if the triangle has no area on the grid of tenths, where it would be invisible.
    static bool vanishes(const std::array<vec2, 3>& t)
    {
        const auto a = tenths(t[0]), b = tenths(t[1]), c = tenths(t[2]);
        return (b[0] - a[0]) * (c[1] - a[1]) == (b[1] - a[1]) * (c[0] - a[0]);
    }

private:
    static std::array<std::int64_t, 2> tenths(const vec2& p)
    {
        return {std::llround(p.x * 10), std::llround(p.y * 10)};
    }

    void go(char command, const vec2& p)
    {
        const auto next = tenths(p);
        text_ += command;
        number(next[0] - pen_[0]);
        if (next[1] >= pen_[1]) text_ += ' '; // a minus sign separates by itself
        number(next[1] - pen_[1]);
        pen_ = next;
    }

    void number(std::int64_t n)
    {
        std::array<char, 24> digits{};
        text_.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), n).ptr);
    }

    std::string text_;
    std::array<std::int64_t, 2> pen_{};
};

} // namespace taut::io::impl
