// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <taut/bake.hpp>
#include <taut/errors.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// A texture that is read row by row, in the numbers that its file has: a large image takes no more than these.
struct texture_rows
{
    idx width = 0, height = 0, channels = 0;
    int bytes = 4;                 ///< of a number: 4 of floats, which are values; 1 or 2 of those that `table` tells
    bool palette = false;          ///< whether a texel has one number, and not one a channel
    std::vector<float> table = {}; ///< `channels` values of each number
    std::function<void(idx row, std::byte* to)> read = {}; ///< copies the numbers of a row, row 0 at v = 0

    std::size_t numbers_of_row() const
    {
        return static_cast<std::size_t>(width) * (palette ? 1 : static_cast<std::size_t>(channels));
    }
    std::size_t bytes_of_row() const { return numbers_of_row() * static_cast<std::size_t>(bytes); }

    /// Values of a row, `channels` a texel.
    void values(idx row, float* to) const
    {
        if (bytes == 4) return read(row, reinterpret_cast<std::byte*>(to));
        std::vector<std::byte> stored(bytes_of_row());
        read(row, stored.data());
        const auto n = static_cast<std::size_t>(channels);
        for (std::size_t k = 0; k < n * static_cast<std::size_t>(width); ++k)
        {
            const std::size_t at = palette ? k / n : k;
            std::size_t number = std::to_integer<std::size_t>(stored[at]);
            if (bytes == 2)
            {
                unsigned short wide = 0;
                std::memcpy(&wide, &stored[2 * at], 2);
                number = wide;
            }
            to[k] = table[n * number + k % n];
        }
    }

    /// f(x) of all values but alpha, the second or fourth channel; of those with a table.
    template <class F>
    void change_colours(F f)
    {
        const auto n = static_cast<std::size_t>(channels);
        for (std::size_t k = 0; k < table.size(); ++k)
            if (n % 2 != 0 || k % n + 1 != n) table[k] = f(table[k]);
    }

    /// Throws parameter_error: sizes from 1 to 65,536, 1 to 4 channels.
    void validate(const std::string& name) const
    {
        if (width < 1 || height < 1 || width > 65536 || height > 65536)
            throw parameter_error(name, "has " + std::to_string(width) + " x " + std::to_string(height) +
                                            " texels; give 1 to 65536 along each side");
        if (channels < 1 || channels > 4)
            throw parameter_error(name, "has " + std::to_string(channels) + " channels; give 1 to 4");
    }
};

/// A texture whose rows lie in memory with the top one first: copy(row from the top, to).
inline texture_rows from_top(texture_rows shape, std::function<void(std::size_t row, std::byte* to)> copy)
{
    shape.read = [height = shape.height, copy = std::move(copy)](idx row, std::byte* to)
    { copy(static_cast<std::size_t>(height - 1 - row), to); };
    return shape;
}

/// The rows of a texture, which has to live as long.
inline texture_rows rows_of(const texture& image)
{
    const auto row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    return {.width = image.width,
            .height = image.height,
            .channels = image.channels,
            .read = [&image, row](idx j, std::byte* to)
            { std::memcpy(to, &image.texels[static_cast<std::size_t>(j) * row], row * sizeof(float)); }};
}

} // namespace taut::impl
