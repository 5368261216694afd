// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <taut/impl/core/error.hpp>
#include <taut/impl/core/types.hpp>

namespace taut
{

/// Image of a texture: width x height texels of 1 to 4 numbers each, linear (not encoded as sRGB). Row 0 is at v = 0,
/// and v runs upwards, as in OBJ: the centre of texel (i, j) is at ((i + 0.5) / width, (j + 0.5) / height). Files have
/// their top row first.
struct texture
{
    /// Interpolation between texels.
    enum class filter
    {
        bilinear, ///< of the four texels around
        nearest   ///< the texel that the place is in: for numbers that are labels
    };

    /// Continuation of a texture beyond the unit square.
    enum class wrap
    {
        repeat,
        clamp ///< the texel of the border
    };

    idx width = 0, height = 0, channels = 0;
    std::vector<float> texels; ///< row by row, the channels of a texel one after the other

    /// Throws parameter_error: sizes from 1 to 65,536, 1 to 4 channels, as many numbers.
    void validate(const std::string& name = "texture") const
    {
        if (width < 1 || height < 1 || width > 65536 || height > 65536)
            throw parameter_error(name, "has " + std::to_string(width) + " x " + std::to_string(height) +
                                            " texels; give 1 to 65536 along each side");
        if (channels < 1 || channels > 4)
            throw parameter_error(name, "has " + std::to_string(channels) + " channels; give 1 to 4");
        if (texels.size() != size())
            throw parameter_error(name, "has " + std::to_string(texels.size()) + " numbers for " +
                                            std::to_string(size()) + "; give width * height * channels");
    }

    std::size_t size() const
    {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(channels);
    }

    const float* at(idx i, idx j) const
    {
        return texels.data() +
               (static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)) *
                   static_cast<std::size_t>(channels);
    }

    /// Value of the texture at a place: unused channels are 0. The reference of what devices compute.
    std::array<double, 4> sample(vec2 uv, filter by = filter::bilinear, wrap beyond = wrap::repeat) const
    {
        const auto wrapped = [beyond](double x, idx size)
        {
            const double n = static_cast<double>(size);
            if (beyond == wrap::repeat) x -= n * std::floor(x / n);
            return static_cast<idx>(std::clamp(x, 0.0, n - 1));
        };
        std::array<double, 4> value{};
        const auto add = [&](double x, double y, double weight)
        {
            const float* const texel = at(wrapped(x, width), wrapped(y, height));
            for (idx c = 0; c < channels; ++c)
                value[static_cast<std::size_t>(c)] += weight * static_cast<double>(texel[c]);
        };
        const double x = uv.x * width, y = uv.y * height;
        if (by == filter::nearest)
        {
            add(std::floor(x), std::floor(y), 1);
            return value;
        }
        const double i = std::floor(x - 0.5), j = std::floor(y - 0.5), s = x - 0.5 - i, t = y - 0.5 - j;
        add(i, j, (1 - s) * (1 - t));
        add(i + 1, j, s * (1 - t));
        add(i, j + 1, (1 - s) * t);
        add(i + 1, j + 1, s * t);
        return value;
    }
};

} // namespace taut
