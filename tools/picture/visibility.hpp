// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <picture/camera.hpp>

namespace taut::io::impl
{

/// Visible face at each sample of a grid, by a z-buffer. Shading comes after, once a visible sample instead of once a
/// drawn one.
class visibility
{
public:
    static constexpr std::int32_t nothing = -1;

    visibility(int width, int height)
        : width_(width),
          height_(height),
          face_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), nothing),
          depth_(face_.size(), -std::numeric_limits<float>::infinity())
    {
    }

    int width() const noexcept { return width_; }
    int height() const noexcept { return height_; }
    std::int32_t face(int x, int y) const { return face_[offset(x, y)]; }
    float depth(int x, int y) const { return depth_[offset(x, y)]; }

    /// Draws face number `face`. Corners: x and y in samples, y down, sample (i, j) at ((i, j) + 0.5); z towards the
    /// eye. Of equally near faces the first one stays: the result does not depend on anything but the order of the
    /// calls.
    void draw(std::int32_t face, const std::array<vec3, 3>& t)
    {
        const double area = cross(t[1] - t[0], t[2] - t[0]);
        if (area == 0 || !std::isfinite(area)) return;
        const auto [left, right] = std::minmax({t[0].x, t[1].x, t[2].x});
        const auto [top, bottom] = std::minmax({t[0].y, t[1].y, t[2].y});
        const int x0 = first(left, width_), x1 = first(right, width_), y0 = first(top, height_),
                  y1 = first(bottom, height_);
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x)
            {
                const vec3 w = weights(t, area, x, y);
                if (w.x < 0 || w.y < 0 || w.z < 0) continue;
                const auto z = static_cast<float>(w.x * t[0].z + w.y * t[1].z + w.z * t[2].z);
                const std::size_t at = offset(x, y);
                if (z <= depth_[at]) continue;
                depth_[at] = z;
                face_[at] = face;
            }
    }

    /// Barycentric coordinates of a sample in a triangle.
    static vec3 weights(const std::array<vec3, 3>& t, int x, int y)
    {
        return weights(t, cross(t[1] - t[0], t[2] - t[0]), x, y);
    }

private:
    static double cross(const vec3& a, const vec3& b) { return a.x * b.y - a.y * b.x; }

    static vec3 weights(const std::array<vec3, 3>& t, double area, int x, int y)
    {
        const vec3 p(x + 0.5, y + 0.5, 0);
        const double u = cross(p - t[0], t[2] - t[0]) / area, v = cross(t[1] - t[0], p - t[0]) / area;
        return {1 - u - v, u, v};
    }

    static int first(double x, int end)
    {
        return static_cast<int>(std::clamp(std::ceil(x - 0.5), 0.0, static_cast<double>(end)));
    }

    std::size_t offset(int x, int y) const
    {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }

    int width_;
    int height_;
    std::vector<std::int32_t> face_;
    std::vector<float> depth_;
};

} // namespace taut::io::impl
