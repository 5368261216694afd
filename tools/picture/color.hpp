// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <taut/types.hpp>

/// Colours of pictures: 8-bit sRGB outside, linear light for shading, OKLab where "equally different to the eye"
/// counts.
namespace taut::io
{

/// An opaque colour in 8-bit sRGB.
struct rgb
{
    std::uint8_t r = 0;
    std::uint8_t g = 0;
    std::uint8_t b = 0;

    friend bool operator==(const rgb&, const rgb&) = default;
};

/// The colour of a flipped face: no colour scale here comes near it.
inline constexpr rgb magenta{255, 0, 255};

/// Linear light in [0, 1] -> the sRGB transfer curve, still in [0, 1] (IEC 61966-2-1).
inline double srgb_encode(double linear)
{
    const double x = linear > 0 ? std::min(linear, 1.0) : 0; // NaN is black
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

/// The inverse of srgb_encode.
inline double srgb_decode(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// Linear light -> 8 bits; what the display cannot show is clipped.
inline rgb to_rgb(const vec3& linear)
{
    const auto byte = [](double x) { return static_cast<std::uint8_t>(std::lround(255 * srgb_encode(x))); };
    return {byte(linear.x), byte(linear.y), byte(linear.z)};
}

/// to_rgb for many colours: the curve from a table, exact to one of the 256 steps.
class rgb_encoder
{
public:
    rgb_encoder()
    {
        for (std::size_t i = 0; i < table_.size(); ++i)
            table_[i] = static_cast<std::uint8_t>(std::lround(255 * srgb_encode(double(i) / (size - 1))));
    }

    rgb operator()(const vec3& linear) const { return {byte(linear.x), byte(linear.y), byte(linear.z)}; }

private:
    static constexpr int size = 4096; // the steepest part of the curve, at 0, climbs less than one step an entry

    std::uint8_t byte(double x) const
    {
        return table_[x > 0 ? static_cast<std::size_t>(std::min(x, 1.0) * (size - 1) + 0.5) : 0]; // NaN is black
    }

    std::array<std::uint8_t, size> table_{};
};

inline vec3 to_linear(rgb c)
{
    return {srgb_decode(c.r / 255.0), srgb_decode(c.g / 255.0), srgb_decode(c.b / 255.0)};
}

/// OKLab (lightness in [0, 1], green-red, blue-yellow) -> linear sRGB, unclipped.
/// Source: B. Ottosson, "A perceptual color space for image processing", 2020.
inline vec3 oklab_to_linear(const vec3& lab)
{
    const double l = lab.x + 0.3963377774 * lab.y + 0.2158037573 * lab.z;
    const double m = lab.x - 0.1055613458 * lab.y - 0.0638541728 * lab.z;
    const double s = lab.x - 0.0894841775 * lab.y - 1.2914855480 * lab.z;
    const double l3 = l * l * l, m3 = m * m * m, s3 = s * s * s;
    return {4.0767416621 * l3 - 3.3077115913 * m3 + 0.2309699292 * s3,
            -1.2684380046 * l3 + 2.6097574011 * m3 - 0.3413193965 * s3,
            -0.0041960863 * l3 - 0.7034186147 * m3 + 1.7076147010 * s3};
}

/// Linear sRGB -> OKLab, the inverse of oklab_to_linear.
inline vec3 linear_to_oklab(const vec3& c)
{
    const double l = std::cbrt(0.4122214708 * c.x + 0.5363325363 * c.y + 0.0514459929 * c.z);
    const double m = std::cbrt(0.2119034982 * c.x + 0.6806995451 * c.y + 0.1073969566 * c.z);
    const double s = std::cbrt(0.0883024619 * c.x + 0.2817188376 * c.y + 0.6299787005 * c.z);
    return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
            1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
            0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

} // namespace taut::io
