// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <taut/impl/core/hierarchy/flat_star.hpp>

namespace taut::impl
{

/// True if triangle (a, b, c) is counter-clockwise beyond the rounding error: then its exact determinant is positive.
/// The bound is that of Shewchuk (1997), with a margin.
inline bool surely_positive(const vec2& a, const vec2& b, const vec2& c)
{
    const double left = (b.x - a.x) * (c.y - a.y), right = (b.y - a.y) * (c.x - a.x);
    constexpr double u = std::numeric_limits<double>::epsilon() / 2;
    return left - right > 6 * u * (std::abs(left) + std::abs(right)) + std::numeric_limits<double>::min();
}

/// A ring in the map, and the edges that the vertex in it must see from the left.
struct ring_image
{
    std::size_t size = 0;
    bool open = false;
    std::array<vec2, largest_star> corner;

    std::size_t triangles() const { return open ? size - 1 : size; }
    std::size_t next(std::size_t i) const { return i + 1 < size ? i + 1 : 0; }

    bool sees(const vec2& p) const
    {
        for (std::size_t i = 0; i < triangles(); ++i)
            if (!surely_positive(p, corner[i], corner[next(i)])) return false;
        return true;
    }
};

/// Convex polygon, clipped by half-planes.
class convex_region
{
public:
    /// The rectangle [low, high].
    convex_region(const vec2& low, const vec2& high) : size_(4)
    {
        corner_[0] = low;
        corner_[1] = {high.x, low.y};
        corner_[2] = high;
        corner_[3] = {low.x, high.y};
    }

    /// Clips to the left side of the line from a to b.
    void cut(const vec2& a, const vec2& b)
    {
        std::array<vec2, capacity> kept;
        std::size_t count = 0;
        for (std::size_t i = 0; i < size_; ++i)
        {
            const vec2 p = corner_[i], q = corner_[i + 1 < size_ ? i + 1 : 0];
            const double sp = cross(b - a, p - a), sq = cross(b - a, q - a);
            if (sp >= 0) kept[count++] = p;
            if ((sp > 0 && sq < 0) || (sp < 0 && sq > 0)) kept[count++] = p + sp / (sp - sq) * (q - p);
        }
        corner_ = kept;
        size_ = count;
    }

    bool empty() const { return size_ == 0; }

    /// Mean of the corners: inside, and well away from the sides.
    vec2 centre() const
    {
        vec2 sum(0.0);
        for (std::size_t i = 0; i < size_; ++i) sum += corner_[i];
        return sum / static_cast<double>(size_);
    }

private:
    static constexpr std::size_t capacity = 2 * (largest_star + 4); // a cut adds one; rounding may add more
    std::size_t size_;
    std::array<vec2, capacity> corner_;
};

/// A point that sees the ring from inside: the centre of its kernel, or, where rounding spoils that, the first point
/// that does on the way from there to the target, at which the kernel has a corner. Returns false if there is none.
/// The kernel is never empty if the triangulation by spokes from the target is valid.
inline bool kernel_point(const ring_image& ring, std::size_t target, vec2& p)
{
    // Relative to the target, near which the kernel may be tiny.
    const vec2 origin = ring.corner[target];
    vec2 low(0.0), high(0.0);
    for (std::size_t i = 0; i < ring.size; ++i)
    {
        low = glm::min(low, ring.corner[i] - origin);
        high = glm::max(high, ring.corner[i] - origin);
    }
    // The kernel of a boundary vertex reaches out of the mesh; half the size of the ring is far enough.
    const vec2 margin((ring.open ? 0.5 : 0.0) * std::max(high.x - low.x, high.y - low.y));
    convex_region kernel(low - margin, high + margin);
    for (std::size_t i = 0; i < ring.triangles() && !kernel.empty(); ++i)
        kernel.cut(ring.corner[i] - origin, ring.corner[ring.next(i)] - origin);
    if (kernel.empty()) return false;
    const vec2 centre = kernel.centre();
    double t = 1;
    for (int halving = 0; halving < 50; ++halving, t /= 2)
    {
        p = origin + t * centre;
        if (ring.sees(p)) return true;
    }
    return false;
}

} // namespace taut::impl
