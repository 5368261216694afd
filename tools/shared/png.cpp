// SPDX-License-Identifier: MIT
#include "shared/png.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <utility>

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
#if __has_include(<stb/stb_image_write.h>)
#include <stb/stb_image_write.h>
#else
#include <stb_image_write.h>
#endif
#pragma GCC diagnostic pop

namespace taut::tools
{

namespace
{

void append_number(std::string& bytes, std::uint32_t x)
{
    for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(x >> shift & 255);
}

/// A chunk of PNG: its length, name, content and checksum.
void append_chunk(std::string& bytes, std::string content)
{
    append_number(bytes, static_cast<std::uint32_t>(content.size() - 4));
    auto* const data = reinterpret_cast<unsigned char*>(content.data());
    const auto sum = stbiw__crc32(data, static_cast<int>(content.size()));
    bytes += content;
    append_number(bytes, sum);
}

/// 16 bits a number: each row as differences from the one above (filter 2 of PNG).
std::string encode_wide(std::string_view pixels, int width, int height, int channels)
{
    const std::size_t row = 2 * static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
    std::string filtered;
    filtered.reserve((row + 1) * static_cast<std::size_t>(height));
    for (std::size_t j = 0; j < static_cast<std::size_t>(height); ++j)
    {
        filtered += '\2';
        for (std::size_t k = 0; k < row; ++k)
            filtered += static_cast<char>(pixels[j * row + k] - (j > 0 ? pixels[(j - 1) * row + k] : 0));
    }
    int size = 0;
    const std::unique_ptr<unsigned char, void (*)(void*)> packed(
        stbi_zlib_compress(reinterpret_cast<unsigned char*>(filtered.data()), static_cast<int>(filtered.size()), &size,
                           8),
        std::free);
    if (!packed) throw picture_error("png: not enough memory to encode the picture");
    std::string bytes("\x89PNG\r\n\x1a\n", 8), head = "IHDR";
    append_number(head, static_cast<std::uint32_t>(width));
    append_number(head, static_cast<std::uint32_t>(height));
    constexpr char types[] = {0, 4, 2, 6}; // grey, grey and alpha, colours, colours and alpha
    head += {16, types[channels - 1], 0, 0, 0};
    append_chunk(bytes, std::move(head));
    append_chunk(bytes, "IDAT" + std::string(reinterpret_cast<char*>(packed.get()), static_cast<std::size_t>(size)));
    append_chunk(bytes, "IEND");
    return bytes;
}

} // namespace

bool fits_png(int width, int height, int channels, int bits) noexcept
{
    const auto row = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(channels * bits / 8);
    return static_cast<std::uint64_t>(height) * (row + 1) <= 0x7fffffff;
}

std::string encode_png(std::string_view pixels, int width, int height, int channels, int bits)
{
    if (pixels.empty()) throw picture_error("png: the picture has no pixels");
    if (!fits_png(width, height, channels, bits))
        throw picture_error("png: more than 2 GiB; write .exr, or a smaller picture");
    if (bits == 16) return encode_wide(pixels, width, height, channels);
    std::string bytes;
    const auto append = [](void* context, void* data, int size)
    { static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<std::size_t>(size)); };
    const int done = stbi_write_png_to_func(append, &bytes, width, height, channels, pixels.data(), channels * width);
    if (done == 0 || bytes.empty()) throw picture_error("png: not enough memory to encode the picture");
    return bytes;
}

std::string encode_png(const io::image& picture)
{
    const auto size = 3 * picture.pixels().size();
    return encode_png({reinterpret_cast<const char*>(picture.bytes()), size}, picture.width(), picture.height(), 3, 8);
}

} // namespace taut::tools
