// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include <taut/errors.hpp>
#include <taut/impl/files/file/read_file.hpp>

namespace taut::tools
{

/// Throws io_error where decoding an image takes more than a quarter of the memory there is: what is read has the same
/// bound. bytes_per_pixel: that decoding takes. name: in messages
inline void require_memory(std::uint64_t width, std::uint64_t height, std::uint64_t bytes_per_pixel,
                           const std::string& name)
{
    const std::uint64_t most = io::impl::most_bytes_to_read();
    if (width * height <= most / bytes_per_pixel) return; // sides are below 2^32
    throw io::io_error(name, "is " + std::to_string(width) + " x " + std::to_string(height) +
                                 " pixels, which take more than " + std::to_string(most >> 20) +
                                 " MiB to decode, a quarter of the memory there is; reduce the image");
}

} // namespace taut::tools
