// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <taut/impl/bake/texture.hpp>

namespace taut::impl
{

/// Difference of two textures of one size.
struct texture_difference
{
    texture image;          ///< |a - b| by texel and channel; 0 where nothing is compared
    double largest = 0;     ///< of all
    double rms = 0;         ///< root of the mean square over the compared texels and their channels
    std::size_t texels = 0; ///< compared
};

} // namespace taut::impl

namespace taut
{

/// Compares two textures, such as one and what came back of it through another atlas. compared: not 0 for the texels
/// that count, or empty for all. Throws parameter_error if sizes differ.
inline impl::texture_difference compare_textures(const texture& a, const texture& b,
                                                 std::span<const std::uint8_t> compared = {})
{
    a.validate("a");
    b.validate("b");
    if (a.width != b.width || a.height != b.height || a.channels != b.channels)
        throw parameter_error("b", "is of another size than a; give textures of one size");
    const std::size_t count = a.size() / static_cast<std::size_t>(a.channels);
    if (!compared.empty() && compared.size() != count)
        throw parameter_error("compared", "has another number of texels than the textures; give one for each");
    impl::texture_difference result{{a.width, a.height, a.channels, std::vector<float>(a.size(), 0.0f)}, 0, 0, 0};
    const auto channels = static_cast<std::size_t>(a.channels);
    double squares = 0;
    for (std::size_t n = 0; n < count; ++n)
    {
        if (!compared.empty() && compared[n] == 0) continue;
        ++result.texels;
        for (std::size_t k = n * channels; k < (n + 1) * channels; ++k)
        {
            const float d = std::abs(a.texels[k] - b.texels[k]);
            result.image.texels[k] = d;
            result.largest = std::max(result.largest, static_cast<double>(d));
            squares += static_cast<double>(d) * static_cast<double>(d);
        }
    }
    if (result.texels > 0) result.rms = std::sqrt(squares / static_cast<double>(result.texels * channels));
    return result;
}

} // namespace taut
