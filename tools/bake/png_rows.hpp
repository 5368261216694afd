// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace taut::tools
{

/// What the first chunks of a PNG file say.
struct png_head
{
    std::size_t width = 0, height = 0;
    unsigned depth = 0, type = 0;    ///< bits of a number; type of colours, 3: palette
    bool plain = true;               ///< neither interlaced nor packed in another way
    std::string_view palette, alpha; ///< contents of PLTE and tRNS

    unsigned channels() const; ///< numbers of a pixel as stored
    std::size_t bytes_of_row() const { return (width * channels() * depth + 7) / 8; }
};

/// Reads the chunks of a PNG file up to its first data. Throws io_error unless it is as long as its chunks say: memory
/// is asked for by what they say. name: in messages
png_head read_png_head(std::string_view bytes, const std::string& name);

/// The rows of a plain PNG file, without their filters, the top one first: what the head says and no
/// more is taken. Throws io_error.
std::string read_png_rows(std::string_view bytes, const png_head& head, const std::string& name);

} // namespace taut::tools
