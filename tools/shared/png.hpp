// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <picture/image.hpp>
#include <taut/impl/core/error.hpp>

namespace taut::tools
{

/// A picture that could not be encoded.
class picture_error : public error
{
public:
    using error::error;
};

/// The bytes of a PNG file. Errors: picture_error for an empty image.
std::string encode_png(const io::image& picture);

} // namespace taut::tools
