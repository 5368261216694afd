// SPDX-License-Identifier: MIT
#include "bake/png_rows.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include <taut/errors.hpp>

#include "bake/inflate.hpp"

namespace taut::tools
{

namespace
{

constexpr std::size_t signature = 8, head_size = 8, sum_size = 4; // of PNG and of its chunks

std::size_t number_at(std::string_view bytes, std::size_t at)
{
    std::size_t number = 0;
    for (std::size_t k = 0; k < 4; ++k) number = number << 8 | static_cast<unsigned char>(bytes[at + k]);
    return number;
}

/// Calls f(name, content) for each chunk up to the end, or until it returns false. Throws io_error where the file ends
/// before.
template <class F>
void for_each_chunk(std::string_view bytes, const std::string& name, F f)
{
    for (std::size_t at = signature; at + head_size <= bytes.size();)
    {
        const std::size_t length = number_at(bytes, at);
        if (length > bytes.size() - at - head_size) break;
        if (!f(bytes.substr(at + 4, 4), bytes.substr(at + head_size, length))) return;
        at += head_size + length + sum_size;
    }
    throw io::io_error(name, "ends within the image; the file is damaged or cut off, get or save it again");
}

/// Undoes the filter of a row (PNG, section 9), where `above` is the row before without it. step: bytes of a pixel
void undo_filter(unsigned filter, unsigned char* row, const unsigned char* above, std::size_t bytes, std::size_t step)
{
    const auto left = [&](std::size_t k) -> unsigned { return k >= step ? row[k - step] : 0; };
    const auto up = [&](std::size_t k) -> unsigned { return above ? above[k] : 0; };
    const auto paeth = [&](std::size_t k) -> unsigned
    {
        const int a = static_cast<int>(left(k)), b = static_cast<int>(up(k)),
                  c = k >= step && above ? above[k - step] : 0;
        const int p = b - c, q = a - c, da = std::abs(p), db = std::abs(q), dc = std::abs(p + q);
        return static_cast<unsigned>(da <= db && da <= dc ? a : db <= dc ? b : c);
    };
    for (std::size_t k = 0; k < bytes && filter != 0; ++k)
    {
        const unsigned guess = filter == 1   ? left(k)
                               : filter == 2 ? up(k)
                               : filter == 3 ? (left(k) + up(k)) / 2
                                             : paeth(k);
        row[k] = static_cast<unsigned char>(row[k] + guess);
    }
}

} // namespace

unsigned png_head::channels() const
{
    constexpr unsigned numbers[] = {1, 0, 3, 1, 2, 0, 4};
    return type < 7 ? numbers[type] : 0;
}

png_head read_png_head(std::string_view bytes, const std::string& name)
{
    png_head head;
    bool known = false, data = false;
    for_each_chunk(bytes, name,
                   [&](std::string_view chunk, std::string_view content)
                   {
                       if (chunk == "IHDR" && content.size() >= 13)
                       {
                           known = true;
                           head.width = number_at(content, 0);
                           head.height = number_at(content, 4);
                           head.depth = static_cast<unsigned char>(content[8]);
                           head.type = static_cast<unsigned char>(content[9]);
                           head.plain = head.plain && content.substr(10, 3) == std::string_view("\0\0\0", 3);
                       }
                       if (chunk == "CgBI") head.plain = false;
                       if (chunk == "PLTE") head.palette = content;
                       if (chunk == "tRNS" && !data) head.alpha = content;
                       data = data || chunk == "IDAT";
                       return chunk != "IEND";
                   });
    if (!known) throw io::io_error(name, "cannot be decoded: it has no head; save it again");
    return head;
}

std::string read_png_rows(std::string_view bytes, const png_head& head, const std::string& name)
{
    const std::size_t row = head.bytes_of_row(), step = std::max<std::size_t>(1, head.channels() * head.depth / 8);
    if ((row + 1) * head.height > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw io::io_error(name, "has more than 2 GiB of pixels; reduce the image");
    std::string rows((row + 1) * head.height, '\0');
    {
        std::string joined; // one chunk need not be copied
        std::string_view packed;
        for_each_chunk(bytes, name,
                       [&](std::string_view chunk, std::string_view content)
                       {
                           if (chunk == "IDAT" && packed.empty() && joined.empty())
                               packed = content;
                           else if (chunk == "IDAT")
                           {
                               if (joined.empty()) joined = packed;
                               joined += content;
                           }
                           return chunk != "IEND";
                       });
        if (!inflate(joined.empty() ? packed : std::string_view(joined), rows))
            throw io::io_error(name, "cannot be decoded: its data are no " + std::to_string(head.width) + " x " +
                                         std::to_string(head.height) + " pixels; save it again");
    }
    auto* const data = reinterpret_cast<unsigned char*>(rows.data());
    for (std::size_t j = 0; j < head.height; ++j)
    {
        const unsigned filter = data[j * (row + 1)];
        if (filter > 4) throw io::io_error(name, "cannot be decoded: invalid filter; save it again");
        std::copy_n(data + j * (row + 1) + 1, row, data + j * row);
        undo_filter(filter, data + j * row, j > 0 ? data + (j - 1) * row : nullptr, row, step);
    }
    rows.resize(row * head.height);
    return rows;
}

} // namespace taut::tools
