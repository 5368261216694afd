// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <taut/impl/charts/bake/texture_rows.hpp>

namespace taut::tools
{

/// Numbers of an image file.
enum class image_numbers
{
    bytes,  ///< 8 bits from 0 to 1
    shorts, ///< 16 bits from 0 to 1
    floats
};

/// An image file as the rows of a texture: values of PNG and JPEG are from 0 to 1.
struct image_file
{
    impl::texture_rows rows;
    image_numbers numbers = image_numbers::bytes;
};

/// Reads PNG, JPEG or EXR, as the first bytes say, and keeps about as many bytes as the image has: width x height x
/// channels x depth. name: in messages. Throws io_error.
image_file read_image(std::string_view bytes, const std::string& name);

/// Rounds numbers to those that PNG holds; not a number becomes 0, and what is below 0 and above 1 is cut off.
void round_to(texture& image, image_numbers numbers);

/// The bytes of a PNG file, of 8 or 16 bits a number, after round_to(). Throws picture_error.
std::string encode_png(const texture& image, image_numbers numbers);

/// The bytes of an EXR file of floats. Throws picture_error; usage_error where the program was built without tinyexr.
std::string encode_exr(const texture& image);

/// Colours from the numbers of sRGB to linear ones, and back (IEC 61966-2-1); the second or fourth channel is alpha and
/// stays.
void to_linear(texture& image);
void to_linear(impl::texture_rows& rows);
void to_srgb(texture& image);

} // namespace taut::tools
