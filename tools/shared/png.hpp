// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <picture/image.hpp>
#include <taut/errors.hpp>

namespace taut::tools
{

/// A picture that could not be encoded.
class picture_error : public error
{
public:
    using error::error;
};

/// Whether a PNG file of so many pixels can be encoded: it holds up to 2 GiB of them.
bool fits_png(int width, int height, int channels, int bits) noexcept;

/// The bytes of a PNG file of 8 or 16 bits a number (these with the higher byte first), 1 to 4 channels, the top row
/// first. Errors: picture_error
std::string encode_png(std::string_view pixels, int width, int height, int channels, int bits);

/// The bytes of a PNG file. Errors: picture_error for an empty image.
std::string encode_png(const io::image& picture);

} // namespace taut::tools
