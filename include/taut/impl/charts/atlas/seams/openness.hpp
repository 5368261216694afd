// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include <taut/impl/core/core/parallel.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// A tree of boxes about triangles that tells whether a ray meets one of them.
class ray_tree
{
public:
    ray_tree(std::span<const vec3> points, std::span<const std::array<idx, 3>> cells)
        : points_(points), cells_(cells), order_(cells.size())
    {
        std::iota(order_.begin(), order_.end(), idx{0});
        std::vector<vec3> middles;
        middles.reserve(cells.size());
        for (const auto& t : cells) middles.push_back((at(t[0]) + at(t[1]) + at(t[2])) / 3.0);
        if (!cells.empty()) grow(0, cells.size(), middles);
    }

    /// Whether the ray from p along d, not 0, meets a triangle.
    bool meets(const vec3& p, const vec3& d) const
    {
        const vec3 inverse(1 / d.x, 1 / d.y, 1 / d.z);
        std::array<idx, 64> open{};
        std::size_t count = 0;
        if (!nodes_.empty()) open[count++] = 0;
        while (count > 0)
        {
            const node& n = nodes_[u(open[--count])];
            const vec3 a = (n.low - p) * inverse, b = (n.high - p) * inverse;
            const vec3 near = glm::min(a, b), far = glm::max(a, b);
            const double enter = std::max({near.x, near.y, near.z, 0.0}), leave = std::min({far.x, far.y, far.z});
            if (!(enter <= leave)) continue;
            if (n.right > 0)
            {
                open[count++] = n.right;
                open[count++] = static_cast<idx>(&n - nodes_.data()) + 1;
                continue;
            }
            for (idx k = n.first; k < n.first + n.count; ++k)
                if (meets(p, d, cells_[u(order_[u(k)])])) return true;
        }
        return false;
    }

private:
    struct node
    {
        vec3 low, high;
        idx first = 0, count = 0; // of the triangles of a leaf
        idx right = 0;            // the second child; the first one follows the node; 0: a leaf
    };

    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }
    const vec3& at(idx v) const { return points_[u(v)]; }

    /// Halves triangles along the longest side of their box: no deeper than the binary logarithm of their number.
    void grow(std::size_t begin, std::size_t end, const std::vector<vec3>& middles)
    {
        const std::size_t own = nodes_.size();
        node n{vec3(std::numeric_limits<double>::infinity()), vec3(-std::numeric_limits<double>::infinity())};
        for (std::size_t k = begin; k < end; ++k)
            for (const idx v : cells_[u(order_[k])])
            {
                n.low = glm::min(n.low, at(v));
                n.high = glm::max(n.high, at(v));
            }
        n.first = static_cast<idx>(begin);
        n.count = static_cast<idx>(end - begin);
        nodes_.push_back(n);
        if (end - begin <= 4) return;
        const vec3 size = n.high - n.low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::size_t middle = (begin + end) / 2;
        const auto before = [&](idx a, idx b)
        {
            const double x = middles[u(a)][axis], y = middles[u(b)][axis];
            return x < y || (x == y && a < b);
        };
        std::nth_element(order_.begin() + static_cast<std::ptrdiff_t>(begin),
                         order_.begin() + static_cast<std::ptrdiff_t>(middle),
                         order_.begin() + static_cast<std::ptrdiff_t>(end), before);
        grow(begin, middle, middles);
        nodes_[own].right = static_cast<idx>(nodes_.size());
        grow(middle, end, middles);
    }

    /// Möller, Trumbore 1997.
    bool meets(const vec3& p, const vec3& d, const std::array<idx, 3>& t) const
    {
        const vec3 a = at(t[1]) - at(t[0]), b = at(t[2]) - at(t[0]), h = glm::cross(d, b);
        const double det = glm::dot(a, h);
        if (det == 0) return false;
        const vec3 s = p - at(t[0]);
        const double x = glm::dot(s, h) / det;
        if (!(x >= 0 && x <= 1)) return false;
        const vec3 q = glm::cross(s, a);
        const double y = glm::dot(d, q) / det;
        return y >= 0 && x + y <= 1 && glm::dot(b, q) / det > 0;
    }

    std::span<const vec3> points_;
    std::span<const std::array<idx, 3>> cells_;
    std::vector<idx> order_;
    std::vector<node> nodes_;
};

/// How much of what is around a vertex is seen from outside: the part of rays from it, about its normal and weighted by
/// their cosine with it, that meet no triangle; 1 on a convex surface, 0 where it is enclosed. The same directions for
/// all vertices, 64 around the sphere.
inline std::vector<double> vertex_openness(const mesh<triangle>& m)
{
    constexpr int rays = 64;
    std::array<vec3, rays> directions;
    for (int k = 0; k < rays; ++k) // Fibonacci's spiral
    {
        const double z = 1 - (2 * k + 1) / static_cast<double>(rays),
                     angle = k * std::numbers::pi * (3 - std::sqrt(5.0)), r = std::sqrt(1 - z * z);
        directions[static_cast<std::size_t>(k)] = {r * std::cos(angle), r * std::sin(angle), z};
    }
    const auto& points = m.points();
    std::vector<vec3> normals(points.size(), vec3(0.0));
    vec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const auto& t : m.cells())
    {
        const vec3& a = points[static_cast<std::size_t>(t[0])];
        const vec3 n =
            glm::cross(points[static_cast<std::size_t>(t[1])] - a, points[static_cast<std::size_t>(t[2])] - a);
        for (const idx v : t)
        {
            const vec3& x = points[static_cast<std::size_t>(v)];
            normals[static_cast<std::size_t>(v)] += n;
            low = glm::min(low, x);
            high = glm::max(high, x);
        }
    }
    const ray_tree tree(points, m.cells());
    const double away = 1e-4 * glm::length(high - low); // from the triangles of the vertex itself
    std::vector<double> open(points.size(), 1);
    parallel_for(
        points.size(),
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t v = begin; v < end; ++v)
            {
                const double length = glm::length(normals[v]);
                if (!(length > 0)) continue;
                const vec3 n = normals[v] / length, from = points[v] + away * n;
                double seen = 0, all = 0;
                for (const vec3& d : directions)
                {
                    const double cosine = glm::dot(n, d);
                    if (cosine < 0.05) continue;
                    all += cosine;
                    if (!tree.meets(from, d)) seen += cosine;
                }
                open[v] = all > 0 ? seen / all : 1;
            }
        },
        0, 64);
    return open;
}

} // namespace taut::impl
