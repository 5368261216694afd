// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include <picture/image.hpp>

namespace taut::io
{

/// A sheet to draw on, antialiased by samples x samples colours a pixel that resolve() averages.
/// All coordinates are in pixels of the final image: x to the right, y DOWN, (0, 0) the top left corner of the top left
/// pixel. Shapes with a coordinate that is not finite are left out; shapes are clipped at the border.
class canvas
{
public:
    /// Errors: parameter_error as image, and unless samples is in [1, 8].
    canvas(int width, int height, int samples, rgb background)
        : samples_(checked(width, height, samples)), grid_(width * samples, height * samples, background)
    {
    }

    int width() const noexcept { return grid_.width() / samples_; }
    int height() const noexcept { return grid_.height() / samples_; }
    int samples() const noexcept { return samples_; }

    /// The samples themselves, for painters that go sample by sample: sample (i, j) lies at ((i, j) + 0.5) / samples().
    image& grid() noexcept { return grid_; }

    /// Fills a convex polygon. alpha = 1 covers, less lets the background shine through.
    /// Two polygons that share an edge neither leave a gap nor blend a sample twice, whatever their orientation.
    void fill_convex(std::span<const vec2> corners, rgb color, double alpha = 1)
    {
        double top = std::numeric_limits<double>::infinity(), bottom = -top;
        for (const vec2& p : corners)
        {
            if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
            top = std::min(top, p.y);
            bottom = std::max(bottom, p.y);
        }
        // Sample row j is hit when its centre j + 1/2 lies in [top, bottom).
        const int first = first_sample(top, grid_.height()), last = first_sample(bottom, grid_.height());
        for (int row = first; row < last; ++row)
        {
            const double y = (row + 0.5) / samples_;
            double left = std::numeric_limits<double>::infinity(), right = -left;
            for (std::size_t i = 0; i < corners.size(); ++i)
            {
                vec2 a = corners[i], b = corners[i + 1 < corners.size() ? i + 1 : 0];
                if (a.y > b.y) std::swap(a, b); // the same arithmetic from both sides of a shared edge
                if (!(a.y <= y && y < b.y)) continue;
                const double x = a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
                left = std::min(left, x);
                right = std::max(right, x);
            }
            if (left <= right)
                span(row, first_sample(left, grid_.width()), first_sample(right, grid_.width()), color, alpha);
        }
    }

    void fill_triangle(const vec2& a, const vec2& b, const vec2& c, rgb color, double alpha = 1)
    {
        fill_convex(std::array{a, b, c}, color, alpha);
    }

    /// The axis-parallel rectangle between two opposite corners.
    void fill_rectangle(const vec2& a, const vec2& b, rgb color, double alpha = 1)
    {
        fill_convex(std::array{a, vec2(b.x, a.y), b, vec2(a.x, b.y)}, color, alpha);
    }

    /// A segment with round ends; a == b gives a disc.
    void line(const vec2& a, const vec2& b, double width, rgb color, double alpha = 1)
    {
        constexpr int half = 8; // segments of a half circle: round enough up to a few dozen pixels
        const vec2 d = b - a;
        const double length = glm::length(d);
        const vec2 along = length > 0 ? d / length : vec2(1, 0), across(-along.y, along.x);
        std::array<vec2, 2 * (half + 1)> capsule;
        for (int i = 0; i <= half; ++i)
        {
            const double angle = std::numbers::pi * (i / double(half) - 0.5);
            const vec2 r = (width / 2) * (std::cos(angle) * along + std::sin(angle) * across);
            capsule[static_cast<std::size_t>(i)] = b + r;
            capsule[static_cast<std::size_t>(half + 1 + i)] = a - r;
        }
        fill_convex(capsule, color, alpha);
    }

    void disc(const vec2& centre, double radius, rgb color, double alpha = 1)
    {
        line(centre, centre, 2 * radius, color, alpha);
    }

    /// A circle drawn with a pen of the given width.
    void ring(const vec2& centre, double radius, double width, rgb color)
    {
        constexpr int segments = 48;
        const auto point = [&](int i)
        {
            const double angle = 2 * std::numbers::pi * i / segments;
            return centre + radius * vec2(std::cos(angle), std::sin(angle));
        };
        for (int i = 0; i < segments; ++i) line(point(i), point(i + 1), width, color);
    }

    /// The picture: each pixel the mean of its samples, taken on the encoded values, which keeps thin dark lines and
    /// small letters as heavy as they were drawn.
    image resolve() const
    {
        image out(width(), height());
        const int count = samples_ * samples_;
        for (int y = 0; y < out.height(); ++y)
            for (int x = 0; x < out.width(); ++x)
            {
                int r = count / 2, g = r, b = r;
                for (int j = 0; j < samples_; ++j)
                    for (int i = 0; i < samples_; ++i)
                    {
                        const rgb& c = grid_(x * samples_ + i, y * samples_ + j);
                        r += c.r;
                        g += c.g;
                        b += c.b;
                    }
                const auto byte = [count](int sum) { return static_cast<std::uint8_t>(sum / count); };
                out(x, y) = {byte(r), byte(g), byte(b)};
            }
        return out;
    }

private:
    static int checked(int width, int height, int samples)
    {
        if (samples < 1 || samples > 8) throw parameter_error("samples", "must be in [1, 8]");
        if (width < 1 || width > image::largest_side / samples)
            throw parameter_error("width", "times samples must be in [1, 16384]");
        if (height < 1 || height > image::largest_side / samples)
            throw parameter_error("height", "times samples must be in [1, 16384]");
        return samples;
    }

    /// The first sample whose centre is not below x, clamped to the grid.
    int first_sample(double x, int end) const
    {
        return static_cast<int>(std::clamp(std::ceil(x * samples_ - 0.5), 0.0, static_cast<double>(end)));
    }

    void span(int row, int begin, int end, rgb color, double alpha)
    {
        for (int i = begin; i < end; ++i)
        {
            rgb& c = grid_(i, row);
            const auto mix = [alpha](std::uint8_t below, std::uint8_t above)
            { return static_cast<std::uint8_t>(std::lround(below + alpha * (above - below))); };
            c = alpha >= 1 ? color : rgb{mix(c.r, color.r), mix(c.g, color.g), mix(c.b, color.b)};
        }
    }

    int samples_;
    image grid_;
};

} // namespace taut::io
