// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <taut/types.hpp>

namespace taut::impl
{

/// Units of the untangling operator: centred, and scaled so that the mean |det| of a map is 1. Only values of single
/// precision are stored in these units.
template <int D>
struct operator_frame
{
    vec<D> centre{0.0};
    double scale = 1;  ///< user's lengths -> lengths here
    double extent = 1; ///< of the map, here

    /// cells: D + 1 vertex indices each; x: finite points.
    operator_frame(std::span<const std::array<idx, D + 1>> cells, const std::vector<vec<D>>& x)
    {
        vec<D> low(std::numeric_limits<double>::infinity()), high(-low);
        for (const auto& p : x)
        {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        // Halves, because the extent of finite points may overflow.
        centre = 0.5 * low + 0.5 * high;
        const vec<D> half = 0.5 * high - 0.5 * low;
        double size = half[0];
        for (int c = 1; c < D; ++c) size = std::max(size, half[c]);
        if (!(size > 0)) return;

        double sum = 0;
        for (const auto& cell : cells)
        {
            mat<D> edges;
            for (std::size_t k = 0; k < D; ++k)
                edges[static_cast<int>(k)] =
                    x[static_cast<std::size_t>(cell[k + 1])] / size - x[static_cast<std::size_t>(cell[0])] / size;
            sum += std::abs(glm::determinant(edges));
        }
        const double count = static_cast<double>(cells.size()), mean = sum / count;
        // Single precision tells no more than a million places apart.
        extent = std::pow(mean > 0 ? std::max(mean, std::pow(1e-6, D)) : 1 / count, -1.0 / D);
        scale = extent / size;
    }

    float here(double coordinate, int c) const { return static_cast<float>((coordinate - centre[c]) * scale); }
    double there(float coordinate, int c) const { return static_cast<double>(coordinate) / scale + centre[c]; }

    /// Bound of the change of det by rounding the corners of an element of common size to single precision.
    double rounding() const { return 4 * D * extent * static_cast<double>(std::numeric_limits<float>::epsilon()) / 2; }
};

} // namespace taut::impl
