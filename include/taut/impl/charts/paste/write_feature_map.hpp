// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <taut/impl/charts/paste/feature_map.hpp>

namespace taut::io::impl
{

/// Little-endian bytes of numbers.
class exr_text
{
public:
    void bytes(std::string_view text) { text_ += text; }
    void word(std::string_view text) { (text_ += text) += '\0'; }
    void number(std::uint64_t n, std::size_t size)
    {
        for (std::size_t k = 0; k < size; ++k) text_ += static_cast<char>(n >> (8 * k) & 0xffU);
    }
    void real(float x) { number(std::bit_cast<std::uint32_t>(x), 4); }
    void attribute(std::string_view name, std::string_view type, std::size_t size)
    {
        word(name);
        word(type);
        number(size, 4);
    }
    std::size_t size() const { return text_.size(); }
    std::string take() { return std::move(text_); }

private:
    std::string text_;
};

} // namespace taut::io::impl

namespace taut::impl
{

inline std::string feature_map::exr() const
{
    constexpr std::string_view channels = "ABGR"; // in the order of their names, as the format wants them
    const auto right = static_cast<std::uint64_t>(width - 1), bottom = static_cast<std::uint64_t>(height - 1);
    io::impl::exr_text out;
    out.number(20000630, 4); // what an OpenEXR file begins with
    out.number(2, 4);        // version, scan lines
    out.attribute("channels", "chlist", 18 * channels.size() + 1);
    for (const char c : channels)
    {
        out.word(std::string_view(&c, 1));
        out.number(2, 4); // float
        out.number(0, 4); // linear
        out.number(1, 4); // every texel
        out.number(1, 4);
    }
    out.number(0, 1);
    out.attribute("compression", "compression", 1);
    out.number(0, 1);
    for (const char* window : {"dataWindow", "displayWindow"})
    {
        out.attribute(window, "box2i", 16);
        out.number(0, 4);
        out.number(0, 4);
        out.number(right, 4);
        out.number(bottom, 4);
    }
    out.attribute("lineOrder", "lineOrder", 1);
    out.number(0, 1);
    out.attribute("pixelAspectRatio", "float", 4);
    out.real(1);
    out.attribute("screenWindowCenter", "v2f", 8);
    out.real(0);
    out.real(0);
    out.attribute("screenWindowWidth", "float", 4);
    out.real(1);
    out.number(0, 1);

    const std::size_t columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
    const std::size_t line = 4 * channels.size() * columns, first = out.size() + 8 * rows;
    for (std::size_t j = 0; j < rows; ++j) out.number(first + j * (line + 8), 8);
    for (std::size_t j = 0; j < rows; ++j)
    {
        const float* const texels = &values[4 * columns * (rows - 1 - j)];
        out.number(j, 4);
        out.number(line, 4);
        for (std::size_t channel : {3, 2, 1, 0})
            for (std::size_t i = 0; i < columns; ++i)
            {
                const float value = texels[4 * i + channel];
                out.real(channel == 3 && value < 0 ? 0 : value);
            }
    }
    return out.take();
}

} // namespace taut::impl
