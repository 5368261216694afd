// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <taut/impl/core/core/single.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/types.hpp>

/// Placement of coordinates so that floats hold them.
namespace taut::io::impl
{

/// Transform of a node.
struct gltf_placement
{
    vec3 translation = vec3(0.0);
    double scale = 1; ///< a power of two

    bool is_none() const { return translation == vec3(0.0) && scale == 1; }
    /// The point of the mesh that comes to x.
    vec3 of_mesh(const vec3& x) const { return x / scale - translation / scale; }
    /// The same as floats hold it.
    vec3 in_floats(const vec3& x) const
    {
        const vec3 p = of_mesh(x);
        return {taut::impl::in_single(p.x), taut::impl::in_single(p.y), taut::impl::in_single(p.z)};
    }
};

/// Returns whether three points lie on a line or in one point, in exact arithmetic.
inline bool collinear(const vec3& a, const vec3& b, const vec3& c)
{
    for (int i = 0; i < 3; ++i)
    {
        const int j = (i + 1) % 3;
        if (taut::impl::orient2d({a[i], a[j]}, {b[i], b[j]}, {c[i], c[j]}) != 0) return false;
    }
    return true;
}

/// Finds where points are to lie: as they are, or about a middle where they are farther from 0 than they are apart, and
/// scaled where floats do not reach, or where they have few digits.
class gltf_placing
{
public:
    /// triangles: whose points are finite
    gltf_placing(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles)
        : points_(points), triangles_(triangles)
    {
        box();
        const double half = largest(high_ / 2.0 - low_ / 2.0),
                     reach = largest(glm::max(glm::abs(low_), glm::abs(high_)));
        constexpr double small = 0x1p-60, large = 0x1p60; // squares of lengths are floats, too
        if (half > large || (half > 0 && half < small)) best_.scale = std::ldexp(1.0, std::ilogb(half));
        if (reach > 4 * half || best_.scale != 1) best_.translation = low_ / 2.0 + high_ / 2.0;
        const auto flat = collapsing(best_);
        collapsed_ = flat.size();
        if (flat.empty()) return;
        // Floats are finest about 0: what is smallest may lie there, or what most of it is near to.
        gltf_placement other = best_;
        other.translation = points_[u(triangles_[flat[flat.size() / 2]][0])];
        if (const std::size_t n = collapsing(other).size(); n < collapsed_)
        {
            best_ = other;
            collapsed_ = n;
        }
    }

    const gltf_placement& best() const { return best_; }
    std::size_t collapsed() const { return collapsed_; } ///< triangles with an area that have none in floats

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }
    static double largest(const vec3& x) { return std::max({x.x, x.y, x.z}); }

    void box()
    {
        low_ = vec3(std::numeric_limits<double>::max());
        high_ = -low_;
        for (const auto& t : triangles_)
            for (const idx v : t)
            {
                low_ = glm::min(low_, points_[u(v)]);
                high_ = glm::max(high_, points_[u(v)]);
            }
    }

    std::vector<std::size_t> collapsing(const gltf_placement& placement) const
    {
        std::vector<std::size_t> flat;
        for (std::size_t i = 0; i < triangles_.size(); ++i)
        {
            const auto& t = triangles_[i];
            const auto in_floats = [&](std::size_t k) { return placement.in_floats(points_[u(t[k])]); };
            if (!collinear(in_floats(0), in_floats(1), in_floats(2)) ||
                collinear(points_[u(t[0])], points_[u(t[1])], points_[u(t[2])]))
                continue;
            flat.push_back(i);
        }
        return flat;
    }

    std::span<const vec3> points_;
    std::span<const std::array<idx, 3>> triangles_;
    vec3 low_, high_;
    gltf_placement best_;
    std::size_t collapsed_ = 0;
};

} // namespace taut::io::impl
