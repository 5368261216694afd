// SPDX-License-Identifier: MIT
// Pictures are written with stb, which the library and most tests do without: no stb, no test of it.
#if __has_include(<stb/stb_image_write.h>) && __has_include(<stb/stb_image.h>)

#include <algorithm>
#include <cstdint>
#include <string>

#include <doctest/doctest.h>

#include "../../../tools/shared/png.cpp" // the encoder is not in a library of its own

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

using taut::io::image;
using taut::io::rgb;

TEST_CASE("png: a picture encoded and decoded is the same picture")
{
    image picture(37, 11);
    for (int y = 0; y < 11; ++y)
        for (int x = 0; x < 37; ++x)
            picture(x, y) = {static_cast<std::uint8_t>(7 * x), static_cast<std::uint8_t>(20 * y),
                             static_cast<std::uint8_t>(x * y)};
    const std::string bytes = taut::tools::encode_png(picture);
    int width = 0, height = 0, channels = 0;
    unsigned char* decoded = stbi_load_from_memory(reinterpret_cast<const unsigned char*>(bytes.data()),
                                                   static_cast<int>(bytes.size()), &width, &height, &channels, 3);
    REQUIRE(decoded != nullptr);
    CHECK(width == 37);
    CHECK(height == 11);
    CHECK(std::equal(decoded, decoded + 3 * 37 * 11, picture.bytes()));
    stbi_image_free(decoded);
}

TEST_CASE("png: a picture without pixels is an error")
{
    CHECK_THROWS_AS(taut::tools::encode_png(image()), taut::tools::picture_error);
}

#endif
