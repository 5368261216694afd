// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include <picture/format.hpp>
#include <picture/text.hpp>
#include <shared/printable.hpp>

#include "shapes.hpp"

using namespace taut;
using io::canvas;
using io::rgb;
using tools::printable;
using namespace io::impl;

namespace
{

constexpr rgb white{255, 255, 255};

io::image written(std::string_view text, io::anchor at = io::anchor::left, double x = 10)
{
    canvas paper(120, 40, 3, white);
    io::draw_text(paper, {x, 28}, text, {.size = 24, .color = {0, 0, 0}, .at = at});
    return paper.resolve();
}

/// First and last column with ink.
std::array<int, 2> columns(const io::image& picture)
{
    std::array<int, 2> found{picture.width(), -1};
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            if (picture(x, y).r < 128) found = {std::min(found[0], x), std::max(found[1], x)};
    return found;
}

} // namespace

TEST_CASE("glyphs: every path is well formed and stays in its box")
{
    for (int code = 32; code < 127; ++code)
    {
        const glyph& g = glyph_of(static_cast<char>(code));
        CAPTURE(code);
        double widest = 0;
        int strokes = 0;
        trace_glyph(g,
                    [&](const vec2& a, const vec2& b)
                    {
                        ++strokes;
                        for (const vec2& p : {a, b})
                        {
                            CHECK(p.x >= -1e-9);
                            CHECK(p.y >= 1);
                            CHECK(p.y <= 24 + 1e-9);
                            widest = std::max(widest, p.x);
                        }
                    });
        CHECK((strokes > 0) == (code != ' '));
        CHECK(widest <= g.width + 1e-9);
        if (code != ' ') CHECK(widest >= g.width - 1); // no glyph claims room it does not use
    }
}

TEST_CASE("glyphs: all of them look different")
{
    std::vector<io::image> seen;
    for (int code = 33; code < 127; ++code)
    {
        seen.push_back(written(std::string(1, static_cast<char>(code))));
        CAPTURE(code);
        CHECK(std::count(seen.begin(), seen.end(), seen.back()) == 1);
    }
}

TEST_CASE("text: is as wide as text_width says and hangs where its anchor says")
{
    const auto left = columns(written("HamH", io::anchor::left, 10));
    const auto middle = columns(written("HamH", io::anchor::middle, 60));
    const auto right = columns(written("HamH", io::anchor::right, 110));
    const double ham = io::text_width("HamH", 24);
    CHECK(left[0] == doctest::Approx(10).epsilon(0.15));
    CHECK(left[1] - left[0] == doctest::Approx(ham).epsilon(0.06));
    CHECK((middle[0] + middle[1]) / 2.0 == doctest::Approx(60).epsilon(0.03));
    CHECK(right[1] == doctest::Approx(110).epsilon(0.03));
    CHECK(io::text_width("Hamburg 123", 24) > ham);
    CHECK(io::text_width("", 24) == 0);
}

TEST_CASE("text: capitals stand on the base line and are 0.72 of the size high")
{
    const io::image picture = written("H");
    int top = 40, bottom = -1;
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 120; ++x)
            if (picture(x, y).r < 128)
            {
                top = std::min(top, y);
                bottom = std::max(bottom, y);
            }
    CHECK(std::abs(bottom - 28) <= 1);
    CHECK(std::abs(bottom - top - 0.72 * 24) <= 3);
}

TEST_CASE("text: a letter beyond ASCII is one box, whatever its length in bytes")
{
    CHECK(io::text_width("\xC3\xA4", 20) == io::text_width("\xE2\x82\xAC", 20));
    CHECK(written("\xC3\xA4") == written("\xF0\x9F\x90\xAB"));
    CHECK(count_pixels(written("\x01"), white) < 120 * 40);
}

TEST_CASE("format: numbers are short and independent of the locale")
{
    CHECK(format_number(7.44603) == "7.446");
    CHECK(format_number(2) == "2");
    CHECK(format_number(0.5) == "0.5");
    CHECK(format_number(1.5e12) == "1.5e+12");
    CHECK(format_number(std::numeric_limits<double>::infinity()) == "inf");
    CHECK(format_number(-std::numeric_limits<double>::quiet_NaN()) == "nan");
    CHECK(format_count(0) == "0");
    CHECK(format_count(999) == "999");
    CHECK(format_count(1000) == "1,000");
    CHECK(format_count(1513800) == "1,513,800");
}

TEST_CASE("printable: what terminals obey is replaced, all else stays")
{
    CHECK(printable("\x1B[31mred\x07\r") == "?[31mred??");
    CHECK(printable("a\tb\nc \x7F") == "a\tb\nc ?");
    CHECK(printable("K\xC3\xA4se \xE2\x82\xAC \xF0\x9F\x90\xAB") == "K\xC3\xA4se \xE2\x82\xAC \xF0\x9F\x90\xAB");
    CHECK(printable("\xC2\x9B"
                    "31m\xC2\xA0") == "?31m\xC2\xA0"); // CSI in one character
    CHECK(printable("\x9B"
                    "31m\xC3") == "?31m?");
}

TEST_CASE("format: XML text is escaped, broken UTF-8 and control characters are replaced")
{
    CHECK(escape_xml("a<b> & \"c\"") == "a&lt;b&gt; &amp; \"c\"");
    CHECK(escape_xml("K\xC3\xA4se \xE2\x82\xAC \xF0\x9F\x90\xAB") == "K\xC3\xA4se \xE2\x82\xAC \xF0\x9F\x90\xAB");
    CHECK(escape_xml("\x01\n") == "??");
    CHECK(escape_xml("\xC3") == "?");                // cut off
    CHECK(escape_xml("\xC0\xAF") == "??");           // overlong
    CHECK(escape_xml("\xED\xA0\x80") == "???");      // surrogate
    CHECK(escape_xml("\xF4\x90\x80\x80") == "????"); // beyond Unicode
}
