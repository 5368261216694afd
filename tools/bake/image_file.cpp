// SPDX-License-Identifier: MIT
#include "bake/image_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/core/parallel.hpp>

#include "bake/exr_image.hpp"
#include "bake/image_memory.hpp"
#include "bake/inflate.hpp"
#include "bake/png_rows.hpp"
#include "shared/png.hpp"

// Only decoders from memory are used. Static, so that another copy of stb in the same program does no harm.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 65536
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wduplicated-branches"
#pragma GCC diagnostic ignored "-Wuseless-cast"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#if __has_include(<stb/stb_image.h>)
#include <stb/stb_image.h>
#else
#include <stb_image.h>
#endif
#pragma GCC diagnostic pop

namespace taut::tools
{

namespace
{

/// Values of whole numbers from 0 to `most`, the same in all channels.
std::vector<float> even_table(std::size_t most, idx channels)
{
    std::vector<float> table;
    table.reserve((most + 1) * static_cast<std::size_t>(channels));
    for (std::size_t n = 0; n <= most; ++n)
        table.insert(table.end(), static_cast<std::size_t>(channels), static_cast<float>(n) / static_cast<float>(most));
    return table;
}

/// Whether a PNG or JPEG file has the bytes that so many pixels take at least.
bool has_bytes_for(std::string_view bytes, int width, int height)
{
    const auto w = static_cast<std::uint64_t>(width), h = static_cast<std::uint64_t>(height);
    constexpr std::size_t depth = 24, colours = 25; // of PNG's first chunk
    // JPEG spends a bit on 64 pixels at least, deflate a byte on 1032.
    if (!bytes.starts_with("\x89PNG") || bytes.size() <= colours) return w * h <= 8 * 64 * bytes.size();
    constexpr std::uint64_t numbers[] = {1, 0, 3, 1, 2, 0, 4}; // of a pixel, by the type of its colours
    const auto type = std::min<std::size_t>(static_cast<unsigned char>(bytes[colours]), 6);
    const auto bits = std::max<std::uint64_t>(1, numbers[type] * static_cast<unsigned char>(bytes[depth]));
    return h * (1 + w * bits / 8) <= 1032 * bytes.size();
}

/// Whether rows of a PNG file are kept as they are stored; others are left to stb_image.
bool is_kept_packed(const png_head& head)
{
    const unsigned bits = head.depth;
    const bool narrow = bits == 1 || bits == 2 || bits == 4 || bits == 8;
    if (!head.plain || head.width > 65536 || head.height > 65536 || head.width == 0 || head.height == 0) return false;
    if (head.type == 3) return narrow && !head.palette.empty() && head.palette.size() % 3 == 0;
    if (!head.alpha.empty()) return false; // one colour is transparent
    return head.type == 0 ? narrow || bits == 16 : head.channels() > 0 && (bits == 8 || bits == 16);
}

/// Values of the colours of a palette, with alpha where it has some; black beyond its end.
std::vector<float> table_of(const png_head& head)
{
    const std::size_t channels = head.alpha.empty() ? 3 : 4;
    std::vector<float> table(256 * channels, 0.0f);
    const auto byte = [](std::string_view list, std::size_t k, float otherwise)
    { return k < list.size() ? static_cast<float>(static_cast<unsigned char>(list[k])) / 255 : otherwise; };
    for (std::size_t n = 0; n < 256; ++n)
        for (std::size_t c = 0; c < channels; ++c)
            table[n * channels + c] = c < 3 ? byte(head.palette, 3 * n + c, 0) : byte(head.alpha, n, 1);
    return table;
}

image_file read_packed_png(std::string_view bytes, const png_head& head, const std::string& name)
{
    const bool palette = head.type == 3, wide = head.depth == 16;
    impl::texture_rows shape{.width = static_cast<idx>(head.width),
                             .height = static_cast<idx>(head.height),
                             .channels = !palette             ? static_cast<idx>(head.channels())
                                         : head.alpha.empty() ? 3
                                                              : 4,
                             .bytes = wide ? 2 : 1,
                             .palette = palette};
    shape.table = palette ? table_of(head) : even_table((std::size_t(1) << head.depth) - 1, shape.channels);
    const auto rows = std::make_shared<const std::string>(read_png_rows(bytes, head, name));
    const std::size_t numbers = shape.numbers_of_row(), row = head.bytes_of_row();
    const auto copy = [rows, row, numbers, depth = head.depth](std::size_t j, std::byte* to)
    {
        const char* const from = rows->data() + j * row;
        if (depth == 8) return static_cast<void>(std::memcpy(to, from, row));
        const unsigned each = depth < 8 ? 8 / depth : 1;
        for (std::size_t k = 0; k < numbers; ++k)
            if (depth == 16)
            {
                const auto number = static_cast<std::uint16_t>(static_cast<unsigned char>(from[2 * k]) << 8 |
                                                               static_cast<unsigned char>(from[2 * k + 1]));
                std::memcpy(to + 2 * k, &number, 2);
            }
            else
                to[k] = std::byte(static_cast<unsigned char>(from[k / each]) >>
                                      (8 - depth - depth * static_cast<unsigned>(k % each)) &
                                  ((1U << depth) - 1));
    };
    return {impl::from_top(std::move(shape), copy), wide ? image_numbers::shorts : image_numbers::bytes};
}

image_file read_with_stb(std::string_view bytes, const std::string& name)
{
    const auto* const data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    image_file file;
    const auto take = [&](auto* pixels)
    {
        if (!pixels)
            throw io::io_error(name, "cannot be decoded: " + std::string(stbi_failure_reason()) + "; save it again");
        const std::shared_ptr<void> owner(pixels, stbi_image_free);
        file.rows.width = width;
        file.rows.height = height;
        file.rows.channels = channels;
        file.rows.bytes = sizeof(*pixels);
        file.rows.table = even_table(sizeof(*pixels) == 1 ? 255 : 65535, channels);
        const std::size_t row = file.rows.bytes_of_row();
        file.rows = impl::from_top(std::move(file.rows), [owner, row](std::size_t j, std::byte* to)
                                   { std::memcpy(to, static_cast<const std::byte*>(owner.get()) + j * row, row); });
    };
    if (stbi_is_16_bit_from_memory(data, size) != 0)
    {
        file.numbers = image_numbers::shorts;
        take(stbi_load_16_from_memory(data, size, &width, &height, &channels, 0));
    }
    else
        take(stbi_load_from_memory(data, size, &width, &height, &channels, 0));
    return file;
}

image_file read_png_or_jpeg(std::string_view bytes, const std::string& name)
{
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw io::io_error(name, "more than 2 GiB; reduce the image");
    int width = 0, height = 0, channels = 0;
    png_head head;
    if (bytes.starts_with("\x89PNG")) head = read_png_head(bytes, name);
    if (stbi_info_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()), &width,
                              &height, &channels) != 0 &&
        !has_bytes_for(bytes, width, height))
        throw io::io_error(name, "has " + std::to_string(bytes.size()) + " bytes for " + std::to_string(width) + " x " +
                                     std::to_string(height) +
                                     " pixels; the file is damaged or cut off, get or save it again");
    const bool packed = width > 0 && is_kept_packed(head);
    // A progressive JPEG takes the most: coefficients of two bytes, planes and pixels.
    const auto numbers = static_cast<std::uint64_t>(std::max(1, channels)),
               each = std::uint64_t(head.depth == 16 ? 2 : 1);
    require_memory(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height),
                   numbers * each * (packed ? 2 : 4), name);
    return packed ? read_packed_png(bytes, head, name) : read_with_stb(bytes, name);
}

float linear_of(float x)
{
    return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

/// f(x) of all numbers but alpha.
template <class F>
void change_colours(texture& image, F f)
{
    const auto channels = static_cast<std::size_t>(image.channels);
    const bool alpha = channels % 2 == 0;
    impl::parallel_for(image.texels.size() / channels,
                       [&](std::size_t begin, std::size_t end)
                       {
                           for (std::size_t n = begin; n < end; ++n)
                               for (std::size_t c = 0; c + (alpha ? 1 : 0) < channels; ++c)
                                   image.texels[n * channels + c] = f(image.texels[n * channels + c]);
                       });
}

} // namespace

image_file read_image(std::string_view bytes, const std::string& name)
{
    constexpr std::string_view exr("\x76\x2f\x31\x01", 4), png("\x89PNG", 4), jpeg("\xff\xd8\xff", 3);
    if (bytes.starts_with(png) || bytes.starts_with(jpeg)) return read_png_or_jpeg(bytes, name);
    if (!bytes.starts_with(exr)) throw io::io_error(name, "is no PNG, JPEG or EXR; convert it to PNG");
    return read_exr(bytes, name);
}

bool inflate(std::string_view packed, std::string& to)
{
    if (to.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) return false;
    const auto size = static_cast<int>(to.size());
    return stbi_zlib_decode_buffer(to.data(), size, packed.data(), static_cast<int>(packed.size())) == size;
}

void round_to(texture& image, image_numbers numbers)
{
    const float most = numbers != image_numbers::bytes ? 65535.0f : 255.0f;
    impl::parallel_for(image.texels.size(),
                       [&](std::size_t begin, std::size_t end)
                       {
                           for (std::size_t k = begin; k < end; ++k)
                           {
                               float& x = image.texels[k]; // not a number is 0
                               x = std::round((x > 0 ? std::min(x, 1.0f) : 0.0f) * most) / most;
                           }
                       });
}

std::string encode_png(const texture& image, image_numbers numbers)
{
    const bool wide = numbers != image_numbers::bytes;
    const float most = wide ? 65535.0f : 255.0f;
    const auto row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    std::string pixels(image.texels.size() * (wide ? 2 : 1), '\0');
    impl::parallel_for(
        static_cast<std::size_t>(image.height),
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t j = begin; j < end; ++j)
                for (std::size_t k = 0; k < row; ++k)
                {
                    const float x = image.texels[(static_cast<std::size_t>(image.height) - 1 - j) * row + k];
                    const auto n = static_cast<unsigned>(std::lround(x * most));
                    const std::size_t at = j * row + k;
                    if (wide)
                    {
                        pixels[2 * at] = static_cast<char>(n >> 8);
                        pixels[2 * at + 1] = static_cast<char>(n & 255);
                    }
                    else
                        pixels[at] = static_cast<char>(n);
                }
        },
        0, 16);
    return encode_png(pixels, image.width, image.height, image.channels, wide ? 16 : 8);
}

void to_linear(texture& image)
{
    change_colours(image, linear_of);
}

void to_linear(impl::texture_rows& rows)
{
    rows.change_colours(linear_of);
}

void to_srgb(texture& image)
{
    change_colours(image,
                   [](float x) { return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f; });
}

} // namespace taut::tools
