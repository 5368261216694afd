// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <taut/bake.hpp>

namespace taut::impl
{

/// Sums differences of texels.
class difference_sum
{
public:
    explicit difference_sum(idx channels) : channels_(static_cast<std::size_t>(channels)) {}

    /// Compares a texel; writes |a - b| of each channel.
    void add(const float* a, const float* b, float* differences)
    {
        ++sum_.texels;
        for (std::size_t k = 0; k < channels_; ++k)
        {
            const bool unlike = std::isnan(a[k]) != std::isnan(b[k]);
            const float d = unlike                             ? std::numeric_limits<float>::infinity()
                            : a[k] == b[k] || std::isnan(a[k]) ? 0.0f
                                                               : std::abs(a[k] - b[k]);
            differences[k] = d;
            sum_.unlike += unlike;
            sum_.largest = std::max(sum_.largest, static_cast<double>(d));
            squares_ += static_cast<double>(d) * static_cast<double>(d);
        }
    }

    /// Without an image.
    texture_difference result() const
    {
        texture_difference all = sum_;
        if (all.texels > 0) all.rms = std::sqrt(squares_ / static_cast<double>(all.texels * channels_));
        return all;
    }

private:
    std::size_t channels_;
    texture_difference sum_{};
    double squares_ = 0;
};

} // namespace taut::impl
