// SPDX-License-Identifier: MIT
#include "png.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

#include <unistd.h>

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

void write_whole_file(const std::filesystem::path& path, const std::string& bytes)
{
    // The process id keeps two programs that write the same file apart.
    std::filesystem::path temporary = path;
    temporary += ".part" + std::to_string(::getpid());
    const auto fail = [&](const std::string& reason)
    {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        throw picture_error(path.string() + ": " + reason);
    };

    errno = 0;
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close(); // flushes: a full disk shows here at the latest
    if (!out) fail("cannot be written: " + std::string(errno != 0 ? std::strerror(errno) : "unknown reason"));

    std::error_code failure;
    std::filesystem::rename(temporary, path, failure);
    if (failure) fail("cannot be replaced: " + failure.message());
}

void write_png(const std::filesystem::path& path, const io::image& picture)
{
    write_whole_file(path, encode_png(picture));
}

} // namespace taut::tools
