// SPDX-License-Identifier: MIT
#include "bake/image_file.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#ifdef TAUT_EXR
#include <tinyexr.h>
#endif

#include <taut/impl/core/parallel.hpp>
#include <taut/impl/io/io_error.hpp>

#include "shared/failure.hpp"
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

/// Copies rows of files, the top one first, to those of a texture, f(number) each.
template <class T, class F>
void take_rows(texture& image, const T* from, F f)
{
    const auto row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    image.texels.resize(image.size());
    for (std::size_t j = 0; j < static_cast<std::size_t>(image.height); ++j)
    {
        const T* const source = from + (static_cast<std::size_t>(image.height) - 1 - j) * row;
        std::transform(source, source + row, image.texels.begin() + static_cast<std::ptrdiff_t>(j * row), f);
    }
}

image_file read_with_stb(std::string_view bytes, const std::string& name)
{
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw io::io_error(name, "more than 2 GiB; reduce the image");
    const auto* const data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    image_file file;
    // Deflate makes at most 1032 bytes of one, of which each has 8 pixels; JPEG spends a bit on 64 pixels at least.
    const std::uint64_t pixels_of_byte = bytes.starts_with("\x89PNG") ? 8 * 1032 : 8 * 64;
    if (stbi_info_from_memory(data, size, &width, &height, &channels) != 0 &&
        static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) > pixels_of_byte * bytes.size())
        throw io::io_error(name, "has " + std::to_string(bytes.size()) + " bytes for " + std::to_string(width) + " x " +
                                     std::to_string(height) +
                                     " pixels; the file is damaged or cut off, get or save it again");
    const auto fail = [&]
    { throw io::io_error(name, "cannot be decoded: " + std::string(stbi_failure_reason()) + "; save it again"); };
    const auto take = [&](auto* pixels, float most)
    {
        if (!pixels) fail();
        const std::unique_ptr<void, void (*)(void*)> owner(pixels, stbi_image_free);
        file.image.width = width;
        file.image.height = height;
        file.image.channels = channels;
        take_rows(file.image, pixels, [most](auto x) { return static_cast<float>(x) / most; });
    };
    if (stbi_is_16_bit_from_memory(data, size) != 0)
    {
        file.numbers = image_numbers::shorts;
        take(stbi_load_16_from_memory(data, size, &width, &height, &channels, 0), 65535.0f);
    }
    else
        take(stbi_load_from_memory(data, size, &width, &height, &channels, 0), 255.0f);
    return file;
}

#ifdef TAUT_EXR

/// Frees what tinyexr says of an error.
std::string exr_message(const char* error)
{
    std::string text = error ? error : "unknown error";
    if (error) FreeEXRErrorMessage(error);
    return text;
}

image_file read_exr(std::string_view bytes, const std::string& name)
{
    const auto* const data = reinterpret_cast<const unsigned char*>(bytes.data());
    const char* error = nullptr;
    EXRVersion version;
    EXRHeader header;
    InitEXRHeader(&header);
    if (ParseEXRVersionFromMemory(&version, data, bytes.size()) != TINYEXR_SUCCESS || version.multipart != 0 ||
        version.non_image != 0 ||
        ParseEXRHeaderFromMemory(&header, &version, data, bytes.size(), &error) != TINYEXR_SUCCESS)
        throw io::io_error(name, "is no EXR of one part that can be read: " + exr_message(error) + "; save it again");
    const int count = header.num_channels;
    bool alpha = false;
    for (int c = 0; c < count; ++c) alpha = alpha || std::strcmp(header.channels[c].name, "A") == 0;
    FreeEXRHeader(&header);
    float* rgba = nullptr;
    int width = 0, height = 0;
    if (LoadEXRFromMemory(&rgba, &width, &height, data, bytes.size(), &error) != TINYEXR_SUCCESS)
        throw io::io_error(name, "cannot be decoded: " + exr_message(error) + "; save it as one layer of R, G, B");
    const std::unique_ptr<float, void (*)(void*)> owner(rgba, std::free);
    const int channels = count == 1 ? 1 : alpha ? 4 : 3;
    image_file file{{width, height, channels, {}}, image_numbers::floats};
    std::vector<float> kept;
    kept.reserve(file.image.size());
    for (std::size_t n = 0; n < static_cast<std::size_t>(width) * static_cast<std::size_t>(height); ++n)
        kept.insert(kept.end(), rgba + 4 * n, rgba + 4 * n + channels);
    take_rows(file.image, kept.data(), [](float x) { return x; });
    return file;
}

#endif

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
    if (bytes.starts_with(png) || bytes.starts_with(jpeg)) return read_with_stb(bytes, name);
    if (!bytes.starts_with(exr)) throw io::io_error(name, "is no PNG, JPEG or EXR; convert it to PNG");
#ifdef TAUT_EXR
    return read_exr(bytes, name);
#else
    throw io::io_error(name, "is EXR, which this program was built without (tinyexr); convert it to PNG of 16 bits");
#endif
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
                    // Not a number is 0.
                    const auto n = static_cast<unsigned>(std::lround((x > 0 ? std::min(x, 1.0f) : 0.0f) * most));
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

std::string encode_exr([[maybe_unused]] const texture& image)
{
#ifdef TAUT_EXR
    // Channels are in the order of their names.
    constexpr const char* names[4][4] = {{"Y"}, {"A", "Y"}, {"B", "G", "R"}, {"A", "B", "G", "R"}};
    const auto channels = static_cast<std::size_t>(image.channels);
    const auto count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    std::vector<std::vector<float>> planes(channels, std::vector<float>(count));
    const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
    for (std::size_t j = 0; j < height; ++j)
        for (std::size_t i = 0; i < width; ++i)
            for (std::size_t c = 0; c < channels; ++c)
                planes[channels - 1 - c][j * width + i] = image.texels[((height - 1 - j) * width + i) * channels + c];
    std::vector<float*> pointers;
    for (auto& plane : planes) pointers.push_back(plane.data());
    std::vector<EXRChannelInfo> infos(channels);
    std::vector<int> types(channels, TINYEXR_PIXELTYPE_FLOAT);
    for (std::size_t c = 0; c < channels; ++c)
    {
        infos[c] = {};
        std::strncpy(infos[c].name, names[channels - 1][c], 255);
    }
    EXRHeader header;
    InitEXRHeader(&header);
    header.num_channels = image.channels;
    header.channels = infos.data();
    header.pixel_types = types.data();
    header.requested_pixel_types = types.data();
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
    EXRImage picture;
    InitEXRImage(&picture);
    picture.images = reinterpret_cast<unsigned char**>(pointers.data());
    picture.num_channels = image.channels;
    picture.width = image.width;
    picture.height = image.height;
    unsigned char* memory = nullptr;
    const char* error = nullptr;
    const std::size_t size = SaveEXRImageToMemory(&picture, &header, &memory, &error);
    const std::unique_ptr<unsigned char, void (*)(void*)> owner(memory, std::free);
    if (size == 0) throw picture_error("exr: " + exr_message(error));
    return std::string(reinterpret_cast<const char*>(memory), size);
#else
    throw usage_error("this program was built without EXR (tinyexr); name the output .png");
#endif
}

void to_linear(texture& image)
{
    change_colours(image, [](float x) { return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f); });
}

void to_srgb(texture& image)
{
    change_colours(image,
                   [](float x) { return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f; });
}

} // namespace taut::tools
