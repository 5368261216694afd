// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <picture/palette.hpp>
#include <taut/errors.hpp>

namespace taut::io
{

/// Width x height pixels of 8-bit sRGB. Rows run from the top to the bottom, a row from left to right, with no padding:
/// bytes() is what image encoders take.
class image
{
public:
    static constexpr int largest_side = 16384;

    image() = default;

    /// Errors: parameter_error unless both sides are in [1, largest_side].
    image(int width, int height, rgb background = {255, 255, 255}) : width_(width), height_(height)
    {
        if (width < 1 || width > largest_side) throw parameter_error("width", "must be in [1, 16384]");
        if (height < 1 || height > largest_side) throw parameter_error("height", "must be in [1, 16384]");
        pixels_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), background);
    }

    int width() const noexcept { return width_; }
    int height() const noexcept { return height_; }

    rgb& operator()(int x, int y) { return pixels_[offset(x, y)]; }
    const rgb& operator()(int x, int y) const { return pixels_[offset(x, y)]; }

    std::vector<rgb>& pixels() noexcept { return pixels_; }
    const std::vector<rgb>& pixels() const noexcept { return pixels_; }

    /// 3 * width * height bytes: r g b r g b ...
    const std::uint8_t* bytes() const noexcept { return pixels_.empty() ? nullptr : &pixels_.front().r; }

    friend bool operator==(const image&, const image&) = default;

private:
    std::size_t offset(int x, int y) const
    {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }

    int width_ = 0;
    int height_ = 0;
    std::vector<rgb> pixels_;
};

static_assert(sizeof(rgb) == 3, "bytes() relies on packed pixels");

/// Pictures next to each other, top edges aligned, with `gap` pixels of the ground between them: before and after.
inline image side_by_side(const std::vector<image>& pictures, int gap = 0, rgb ground = wished_palette().ground)
{
    int width = pictures.empty() ? 0 : gap * (static_cast<int>(pictures.size()) - 1), height = 0;
    for (const image& p : pictures)
    {
        width += p.width();
        height = std::max(height, p.height());
    }
    image sheet(width, height, ground);
    int left = 0;
    for (const image& p : pictures)
    {
        for (int y = 0; y < p.height(); ++y)
            for (int x = 0; x < p.width(); ++x) sheet(left + x, y) = p(x, y);
        left += p.width() + gap;
    }
    return sheet;
}

} // namespace taut::io
