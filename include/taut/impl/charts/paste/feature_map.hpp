// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <taut/queue.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Geometry image of a feature: positions (not heights, so that overhangs are represented) over a map of it to the
/// plane: paper, section 4.1. Positions are in the frame of the base: along its two axes and its normal, from its
/// centre.
struct feature_map
{
    idx width = 0, height = 0;
    vec2 low{0.0};             ///< the corner of texel (0, 0) in the plane
    double texel = 1;          ///< side of a texel in the plane
    std::vector<float> values; ///< 4 a texel, row by row: x, y, z; 1 where a triangle covers its centre, -1 where it is
                               ///< continued beyond the rim, 0 where there is nothing
    double footprint = 0;      ///< mean length on the feature that a texel stands for
    double round_trip = 0;     ///< largest distance of a vertex of the feature from what is sampled at its place
    double round_trip_rms = 0;

    /// A point of the plane in texels.
    vec2 in_texels(const vec2& p) const { return (p - low) / texel; }

    /// Encodes the map as an OpenEXR file, and returns its bytes: R, G, B are x, y, z in the frame of the base as
    /// 32-bit floats, A is 1 where a triangle covers a texel and 0 elsewhere. Scan lines, not compressed, the first row
    /// of the map at the bottom.
    std::string exr() const;

    bool covers(idx i, idx j) const { return values[4 * static_cast<std::size_t>(j * width + i) + 3] == 1; }

    /// The position at a point of the plane, bilinear. The reference of the kernel.
    vec3 operator()(const vec2& p) const
    {
        const vec2 q = glm::clamp(in_texels(p) - 0.5, vec2(0.0), vec2(width - 1, height - 1));
        const idx i = std::min(static_cast<idx>(q.x), width - 2), j = std::min(static_cast<idx>(q.y), height - 2);
        const auto at = [&](idx di, idx dj)
        {
            const float* v = &values[4 * static_cast<std::size_t>((j + dj) * width + i + di)];
            return vec3(double(v[0]), double(v[1]), double(v[2]));
        };
        const double s = q.x - i, t = q.y - j;
        return (1 - t) * ((1 - s) * at(0, 0) + s * at(1, 0)) + t * ((1 - s) * at(0, 1) + s * at(1, 1));
    }
};

/// Samples a map at points of the plane, on the device.
std::vector<vec3> sample(queue& q, const feature_map& map, std::span<const vec2> points);

} // namespace taut::impl
