// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <taut/impl/bake/texture.hpp>

namespace taut::tools
{

/// Numbers of an image file.
enum class image_numbers
{
    bytes,  ///< 8 bits from 0 to 1
    shorts, ///< 16 bits from 0 to 1
    floats
};

/// An image file as numbers: those of PNG and JPEG from 0 to 1, as they are stored.
struct image_file
{
    texture image;
    image_numbers numbers = image_numbers::bytes;
};

/// Reads PNG, JPEG or EXR, as the first bytes say. name: in messages. Throws io_error.
image_file read_image(std::string_view bytes, const std::string& name);

/// The bytes of a PNG file, of 8 or 16 bits a number; numbers below 0 and above 1 are cut off. Throws picture_error.
std::string encode_png(const texture& image, image_numbers numbers);

/// The bytes of an EXR file of floats. Throws picture_error; usage_error where the program was built without tinyexr.
std::string encode_exr(const texture& image);

/// Colours from the numbers of sRGB to linear ones, and back (IEC 61966-2-1); the second or fourth channel is alpha and
/// stays.
void to_linear(texture& image);
void to_srgb(texture& image);

} // namespace taut::tools
