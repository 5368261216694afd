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

/// Whether a PNG file is as long as its chunks say: memory is asked for by what they say.
bool has_its_chunks(std::string_view bytes)
{
    constexpr std::size_t signature = 8, head = 8, sum = 4;
    for (std::size_t at = signature; at + head <= bytes.size();)
    {
        std::size_t length = 0;
        for (std::size_t k = 0; k < 4; ++k) length = length << 8 | static_cast<unsigned char>(bytes[at + k]);
        if (length > bytes.size() - at - head) return false;
        if (bytes.substr(at + 4, 4) == "IEND") return true;
        at += head + length + sum;
    }
    return false;
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

image_file read_with_stb(std::string_view bytes, const std::string& name)
{
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw io::io_error(name, "more than 2 GiB; reduce the image");
    const auto* const data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    image_file file;
    if (bytes.starts_with("\x89PNG") && !has_its_chunks(bytes))
        throw io::io_error(name, "ends within the image; the file is damaged or cut off, get or save it again");
    if (stbi_info_from_memory(data, size, &width, &height, &channels) != 0 && !has_bytes_for(bytes, width, height))
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

/// An EXR file of one part. What tinyexr has made of it by then is freed when its reading fails, too.
class exr_reader
{
public:
    exr_reader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name)
    {
        InitEXRHeader(&header_);
        InitEXRImage(&image_);
    }
    ~exr_reader()
    {
        FreeEXRImage(&image_);
        FreeEXRHeader(&header_);
    }
    exr_reader(const exr_reader&) = delete;
    exr_reader& operator=(const exr_reader&) = delete;

    image_file read()
    {
        read_header();
        const auto planes = find_channels();
        image_.num_channels = header_.num_channels; // so that tinyexr frees all of them when it fails
        const char* error = nullptr;
        if (LoadEXRImageFromMemory(&image_, &header_, data(), bytes_.size(), &error) != TINYEXR_SUCCESS)
        {
            InitEXRImage(&image_); // it has freed what it had
            throw io::io_error(name_, "cannot be decoded: " + exr_message(error) + "; save it as one layer of R, G, B");
        }
        const int channels = static_cast<int>(planes.size());
        image_file file{{image_.width, image_.height, channels, {}}, image_numbers::floats};
        std::vector<float> kept(file.image.size());
        for (std::size_t c = 0; c < planes.size(); ++c) copy_plane(kept.data() + c, planes.size(), planes[c]);
        take_rows(file.image, kept.data(), [](float x) { return x; });
        return file;
    }

private:
    const unsigned char* data() const { return reinterpret_cast<const unsigned char*>(bytes_.data()); }

    /// A whole number of the file, which is little-endian.
    template <class Number>
    Number number_at(std::size_t at) const
    {
        Number number = 0;
        for (std::size_t k = 0; k < sizeof(Number); ++k)
            number |= static_cast<Number>(static_cast<Number>(static_cast<unsigned char>(bytes_[at + k])) << (8 * k));
        return number;
    }

    /// Whether the attributes on which tinyexr ends the program hold what it takes for granted; it reports others.
    bool attributes_hold(bool tiled) const
    {
        bool has_tiles = false;
        std::size_t at = version_bytes;
        for (int read = 0; at < bytes_.size() && bytes_[at] != '\0'; ++read)
        {
            if (read == TINYEXR_MAX_HEADER_ATTRIBUTES) return false; // the rest would not be read
            const std::size_t type = bytes_.find('\0', at) + 1;
            const std::size_t length = type == 0 ? 0 : bytes_.find('\0', type) + 1;
            if (length == 0 || bytes_.size() - length < 4) break;
            const std::size_t begin = length + 4, size = number_at<std::uint32_t>(length);
            if (size > bytes_.size() - begin) break;
            const std::string_view name = bytes_.substr(at, type - 1 - at), value = bytes_.substr(begin, size);
            if (name == "type" && value.substr(0, value.find('\0')) != (tiled ? "tiledimage" : "scanlineimage"))
                return false;
            if (name == "tiles" && size != 9) return false;
            has_tiles = has_tiles || name == "tiles";
            at = begin + size;
        }
        return has_tiles || !tiled;
    }

    /// Throws error unless the table of tiles leads to tiles of the image: tinyexr reads where it is told to.
    void check_tiles(std::uint64_t width, std::uint64_t height) const
    {
        const auto fail = [&](const char* what)
        { throw io::io_error(name_, std::string(what) + "; save it in scan lines"); };
        if (header_.tile_level_mode != TINYEXR_TILE_ONE_LEVEL) fail("has several levels");
        if (header_.tile_size_x < 1 || header_.tile_size_y < 1) fail("has tiles without pixels");
        const auto across = static_cast<std::uint64_t>(header_.tile_size_x),
                   down = static_cast<std::uint64_t>(header_.tile_size_y);
        const std::uint64_t columns = (width + across - 1) / across, rows = (height + down - 1) / down;
        const std::size_t table = version_bytes + header_.header_len;
        constexpr std::size_t head = 5 * sizeof(std::int32_t); // column, row, two levels, size
        if (table > bytes_.size() || columns * rows > (bytes_.size() - table) / sizeof(std::uint64_t) ||
            bytes_.size() < head)
            fail("ends within its tiles");
        check_bytes(columns * rows, across, down);
        for (std::size_t n = 0; n < columns * rows; ++n)
        {
            const auto at = number_at<std::uint64_t>(table + n * sizeof(std::uint64_t));
            if (at == 0 || at > bytes_.size() - head || number_at<std::uint32_t>(at) >= columns ||
                number_at<std::uint32_t>(at + 4) >= rows)
                fail("has tiles outside of the image or the file");
        }
    }

    /// Throws error if the file is too short for so many pieces of width x height: no compression makes more than some
    /// 1032 bytes of one, as deflate does, and a number has two at least.
    void check_bytes(std::uint64_t pieces, std::uint64_t width, std::uint64_t height) const
    {
        const std::uint64_t most = 550 * bytes_.size() / static_cast<std::uint64_t>(header_.num_channels);
        if (width > most || height > most || width * height > most / pieces)
            throw io::io_error(name_, "has " + std::to_string(bytes_.size()) + " bytes for " + std::to_string(pieces) +
                                          " of " + std::to_string(width) + " x " + std::to_string(height) +
                                          " pixels; the file is damaged or cut off, get or save it again");
    }

    void read_header()
    {
        EXRVersion version;
        const char* error = nullptr;
        if (ParseEXRVersionFromMemory(&version, data(), bytes_.size()) != TINYEXR_SUCCESS || version.multipart != 0 ||
            version.non_image != 0 || !attributes_hold(version.tiled != 0) ||
            ParseEXRHeaderFromMemory(&header_, &version, data(), bytes_.size(), &error) != TINYEXR_SUCCESS)
            throw io::io_error(name_,
                               "is no EXR of one part that can be read: " + exr_message(error) + "; save it again");
        const auto extent = [](int low, int high) { return static_cast<std::int64_t>(high) - low + 1; };
        const auto& window = header_.data_window;
        const auto width = extent(window.min_x, window.max_x), height = extent(window.min_y, window.max_y);
        constexpr std::int64_t most = 65536;
        if (width < 1 || height < 1 || width > most || height > most)
            throw io::io_error(name_, "is " + std::to_string(width) + " x " + std::to_string(height) +
                                          " pixels; 1 to 65536 are read");
        check_bytes(1, static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height));
        if (header_.tiled != 0) check_tiles(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height));
    }

    /// Numbers of the channels in the order of a texture; asks for floats.
    std::vector<int> find_channels()
    {
        const auto number_of = [this](const char* name)
        {
            for (int c = 0; c < header_.num_channels; ++c)
                if (std::strcmp(header_.channels[c].name, name) == 0) return c;
            return -1;
        };
        std::vector<int> found = {0};
        if (header_.num_channels != 1) found = {number_of("R"), number_of("G"), number_of("B")};
        if (header_.num_channels < 1 || std::find(found.begin(), found.end(), -1) != found.end())
            throw io::io_error(name_, "has no channels R, G, B, nor a single one; save it as one layer of R, G, B");
        if (const int alpha = number_of("A"); header_.num_channels != 1 && alpha >= 0) found.push_back(alpha);
        for (const int c : found)
            if (header_.pixel_types[c] == TINYEXR_PIXELTYPE_UINT)
                throw io::io_error(name_, "has whole numbers; save it as half or float");
        for (int c = 0; c < header_.num_channels; ++c)
            if (header_.pixel_types[c] == TINYEXR_PIXELTYPE_HALF)
                header_.requested_pixel_types[c] = TINYEXR_PIXELTYPE_FLOAT;
        return found;
    }

    /// Copies a channel to every `step`-th number.
    void copy_plane(float* to, std::size_t step, int channel) const
    {
        const auto width = static_cast<std::size_t>(image_.width), height = static_cast<std::size_t>(image_.height);
        const auto plane = [channel](unsigned char** images) { return reinterpret_cast<float**>(images)[channel]; };
        if (header_.tiled == 0)
        {
            for (std::size_t n = 0; n < width * height; ++n) to[n * step] = plane(image_.images)[n];
            return;
        }
        const auto columns = static_cast<std::size_t>(header_.tile_size_x),
                   rows = static_cast<std::size_t>(header_.tile_size_y);
        for (int t = 0; t < image_.num_tiles; ++t)
        {
            const EXRTile& tile = image_.tiles[t];
            const auto x = columns * static_cast<std::size_t>(tile.offset_x),
                       y = rows * static_cast<std::size_t>(tile.offset_y);
            for (std::size_t j = 0; j < rows && y + j < height; ++j)
                for (std::size_t i = 0; i < columns && x + i < width; ++i)
                    to[((y + j) * width + x + i) * step] = plane(tile.images)[j * columns + i];
        }
    }

    static constexpr std::size_t version_bytes = 8; // and the magic number, before the header

    std::string_view bytes_;
    const std::string& name_;
    EXRHeader header_;
    EXRImage image_;
};

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
    return exr_reader(bytes, name).read();
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
