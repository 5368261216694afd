// SPDX-License-Identifier: MIT
#include "shared/png.hpp"

#include <cstddef>

// Only the encoder to memory is used. Static, so that another copy of stb in the same program does no harm.
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace taut::tools
{

std::string encode_png(const io::image& picture)
{
    if (picture.pixels().empty()) throw picture_error("png: the picture has no pixels");
    std::string bytes;
    const auto append = [](void* context, void* data, int size)
    { static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<std::size_t>(size)); };
    const int done = stbi_write_png_to_func(append, &bytes, picture.width(), picture.height(), 3, picture.bytes(),
                                            3 * picture.width());
    if (done == 0 || bytes.empty()) throw picture_error("png: not enough memory to encode the picture");
    return bytes;
}

} // namespace taut::tools
