// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/types.hpp>

namespace taut::impl
{

/// A point of a triangulated surface.
struct surface_place
{
    idx face = -1;
    vec3 weights{0.0}; ///< of its corners, which sum to 1
    double distance = std::numeric_limits<double>::infinity();

    /// Interpolates values at the corners.
    template <class Value>
    Value of(const std::vector<std::array<idx, 3>>& cells, const std::vector<Value>& values) const
    {
        const auto& t = cells[static_cast<std::size_t>(face)];
        const auto at = [&](std::size_t k) { return values[static_cast<std::size_t>(t[k])]; };
        return weights.x * at(0) + weights.y * at(1) + weights.z * at(2);
    }
};

/// The weights of the point of triangle abc that is nearest to p (Ericson, Real-Time Collision Detection, 5.1.5).
inline vec3 nearest_weights(const vec3& p, const vec3& a, const vec3& b, const vec3& c)
{
    const vec3 ab = b - a, ac = c - a;
    const double d1 = glm::dot(ab, p - a), d2 = glm::dot(ac, p - a);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const double d3 = glm::dot(ab, p - b), d4 = glm::dot(ac, p - b);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
    const double d5 = glm::dot(ab, p - c), d6 = glm::dot(ac, p - c);
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1 - w, w};
    }
    const double sum = va + vb + vc;
    return {va / sum, vb / sum, vc / sum};
}

/// A tree of boxes about triangles that finds the nearest point and what is near a box. It refers to points and
/// triangles.
class surface_tree
{
public:
    surface_tree(std::span<const vec3> points, std::span<const std::array<idx, 3>> cells)
        : x_(points), cells_(cells), order_(cells.size())
    {
        for (std::size_t f = 0; f < order_.size(); ++f) order_[f] = static_cast<idx>(f);
        nodes_.reserve(cells.size());
        build(0, order_.size());
    }

    surface_place nearest(const vec3& p) const
    {
        surface_place best;
        std::vector<std::pair<double, std::size_t>> stack{{nodes_[0].distance(p), 0}};
        while (!stack.empty())
        {
            const auto [distance, at] = stack.back();
            stack.pop_back();
            if (distance >= best.distance) continue;
            const node& n = nodes_[at];
            if (n.left == 0)
            {
                for (std::size_t i = n.first; i < n.last; ++i) look(p, order_[i], best);
                continue;
            }
            std::pair<double, std::size_t> near{nodes_[n.left].distance(p), n.left},
                far{nodes_[n.right].distance(p), n.right};
            if (far < near) std::swap(near, far);
            stack.push_back(far);
            stack.push_back(near);
        }
        return best;
    }

    /// Calls visit(f) for triangles whose box may meet that from low to high.
    template <class Visit>
    void for_each_near(const vec3& low, const vec3& high, const Visit& visit) const
    {
        std::vector<std::size_t> stack{0};
        while (!stack.empty())
        {
            const node& n = nodes_[stack.back()];
            stack.pop_back();
            if (glm::any(glm::lessThan(high, n.low)) || glm::any(glm::lessThan(n.high, low))) continue;
            if (n.left > 0)
                stack.insert(stack.end(), {n.right, n.left});
            else
                for (std::size_t i = n.first; i < n.last; ++i) visit(order_[i]);
        }
    }

private:
    struct node
    {
        vec3 low, high;
        std::size_t first, last, left = 0, right = 0;
        double distance(const vec3& p) const { return glm::length(glm::max(vec3(0.0), glm::max(low - p, p - high))); }
    };

    const vec3& corner(idx f, std::size_t k) const
    {
        return x_[static_cast<std::size_t>(cells_[static_cast<std::size_t>(f)][k])];
    }

    void look(const vec3& p, idx f, surface_place& best) const
    {
        const vec3 w = nearest_weights(p, corner(f, 0), corner(f, 1), corner(f, 2));
        const double d = glm::distance(p, w.x * corner(f, 0) + w.y * corner(f, 1) + w.z * corner(f, 2));
        if (d < best.distance) best = {f, w, d};
    }

    std::size_t build(std::size_t first, std::size_t last)
    {
        const std::size_t self = nodes_.size();
        node n{vec3(std::numeric_limits<double>::infinity()), vec3(-std::numeric_limits<double>::infinity()), first,
               last};
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t k = 0; k < 3; ++k)
            {
                n.low = glm::min(n.low, corner(order_[i], k));
                n.high = glm::max(n.high, corner(order_[i], k));
            }
        nodes_.push_back(n);
        if (last - first <= 4) return self;
        const vec3 extent = n.high - n.low;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const auto middle = first + (last - first) / 2;
        const auto centre = [&](idx f) { return corner(f, 0)[axis] + corner(f, 1)[axis] + corner(f, 2)[axis]; };
        const auto begin = order_.begin();
        std::nth_element(begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(middle),
                         begin + static_cast<std::ptrdiff_t>(last),
                         [&](idx f, idx g) { return centre(f) < centre(g); });
        const std::size_t left = build(first, middle), right = build(middle, last);
        nodes_[self].left = left;
        nodes_[self].right = right;
        return self;
    }

    std::span<const vec3> x_;
    std::span<const std::array<idx, 3>> cells_;
    std::vector<idx> order_;
    std::vector<node> nodes_;
};

} // namespace taut::impl
