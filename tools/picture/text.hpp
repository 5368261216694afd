// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include <picture/canvas.hpp>
#include <picture/glyphs.hpp>

namespace taut::io
{

/// Alignment of a text to its point.
enum class anchor
{
    left,
    middle,
    right
};

/// Style of letters: size in pixels as in CSS (capitals are 0.72 of it), pen width as a part of the size.
struct text_style
{
    double size = 16;
    double weight = 0.085;
    rgb color{40, 44, 52};
    anchor at = anchor::left;
};

namespace impl
{

inline constexpr double base_line = 6;         // of the glyph grid
inline constexpr double grid_cell = 0.72 / 16; // of the grid, in units of the text size: capitals are 16 cells high
inline constexpr double letter_gap = 4.5;

/// UTF-8 beyond ASCII is one unknown glyph a code point: its continuation bytes take no room.
inline bool starts_character(char c)
{
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
}

/// Calls stroke(a, b) for the straight pieces of a glyph, in grid coordinates.
template <class Stroke>
void trace_glyph(const glyph& g, Stroke&& stroke)
{
    constexpr int pieces = 6; // of a quarter ellipse
    std::size_t at = 0;
    const auto skip_blanks = [&]
    {
        while (at < g.path.size() && g.path[at] == ' ') ++at;
    };
    const auto digit = [](char c) { return static_cast<double>(c <= '9' ? c - '0' : c - 'a' + 10); };
    const auto point = [&]
    {
        skip_blanks();
        const vec2 p(digit(g.path[at]), digit(g.path[at + 1]));
        at += 2;
        return p;
    };
    vec2 pen(0);
    for (skip_blanks(); at < g.path.size(); skip_blanks())
    {
        if (g.path[at] == 'M')
        {
            ++at;
            pen = point();
        }
        else if (g.path[at] == 'Q')
        {
            ++at;
            const vec2 corner = point(), end = point(), centre = pen + end - corner, start = pen;
            for (int i = 1; i <= pieces; ++i)
            {
                const double angle = std::numbers::pi / 2 * i / pieces;
                const vec2 next = centre + std::cos(angle) * (start - centre) + std::sin(angle) * (end - centre);
                stroke(pen, next);
                pen = next;
            }
        }
        else
        {
            const vec2 next = point();
            stroke(pen, next);
            pen = next;
        }
    }
}

} // namespace impl

/// The width of a line of text in pixels.
inline double text_width(std::string_view text, double size)
{
    double cells = 0;
    for (char c : text)
        if (impl::starts_character(c)) cells += impl::glyph_of(c).width + impl::letter_gap;
    return cells > 0 ? (cells - impl::letter_gap) * impl::grid_cell * size : 0;
}

/// Draws one line of text whose base line starts, is centred or ends at `position`, by style.at.
inline void draw_text(canvas& paper, vec2 position, std::string_view text, const text_style& style)
{
    const double cell = impl::grid_cell * style.size;
    if (style.at != anchor::left) position.x -= text_width(text, style.size) * (style.at == anchor::middle ? 0.5 : 1);
    for (char c : text)
    {
        if (!impl::starts_character(c)) continue;
        const impl::glyph& g = impl::glyph_of(c);
        const auto place = [&](const vec2& p) { return position + cell * vec2(p.x, impl::base_line - p.y); };
        impl::trace_glyph(g,
                          [&](const vec2& a, const vec2& b)
                          {
                              // A dot needs a little more ink than a line to look as heavy.
                              const double pen = style.weight * style.size * (a == b ? 1.35 : 1);
                              paper.line(place(a), place(b), pen, style.color);
                          });
        position.x += cell * (g.width + impl::letter_gap);
    }
}

} // namespace taut::io
