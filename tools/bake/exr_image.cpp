// SPDX-License-Identifier: MIT
#include "bake/exr_image.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#ifdef TAUT_EXR
#include <tinyexr.h>
#endif

#include <taut/errors.hpp>

#include "bake/image_memory.hpp"
#include "shared/failure.hpp"
#include "shared/png.hpp"

namespace taut::tools
{

#ifdef TAUT_EXR

namespace
{

/// Frees what tinyexr says of an error.
std::string exr_message(const char* error)
{
    std::string text = error ? error : "unknown error";
    if (error) FreeEXRErrorMessage(error);
    text.erase(text.find_last_not_of(".\n") + 1); // a sentence of its own
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
        const auto kept = std::make_shared<std::vector<float>>(static_cast<std::size_t>(image_.width) *
                                                               static_cast<std::size_t>(image_.height) * planes.size());
        for (std::size_t c = 0; c < planes.size(); ++c) copy_plane(kept->data() + c, planes.size(), planes[c]);
        const impl::texture_rows shape{.width = image_.width, .height = image_.height, .channels = channels};
        const std::size_t row = shape.numbers_of_row();
        return {impl::from_top(shape, [kept, row](std::size_t j, std::byte* to)
                               { std::memcpy(to, kept->data() + j * row, row * sizeof(float)); }),
                image_numbers::floats};
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
        require_memory(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height),
                       8 * static_cast<std::uint64_t>(header_.num_channels), name_); // floats of planes and of pixels
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
        if (std::find(found.begin(), found.end(), -1) != found.end())
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

} // namespace

#endif

image_file read_exr([[maybe_unused]] std::string_view bytes, const std::string& name)
{
#ifdef TAUT_EXR
    return exr_reader(bytes, name).read();
#else
    throw io::io_error(name, "is EXR, which this program was built without (tinyexr); convert it to PNG of 16 bits");
#endif
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

} // namespace taut::tools
