// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <tuple>
#include <vector>

#include <taut/impl/core/exact/predicates.hpp>
#include <taut/types.hpp>

namespace taut::io::impl
{

/// Splits polygons into triangles by cutting off corners ("ears"), each time the one with the shortest diagonal among
/// those whose triangle faces as the polygon does and has nothing of the outline inside, as they are seen along the
/// main axis of the polygon's normal; exact. A quad is thus cut along its shorter inner diagonal. An outline may touch
/// itself, as one does that runs in to a hole along a slit and out again; where it comes back to a vertex at once there
/// is nothing to cut off. Self-intersecting polygons are split arbitrarily. O(n log n) for n corners, and the product
/// of corners and reflex ones.
class ear_clipper
{
public:
    /// Steps after which the rest of a polygon is split into a fan, so that the time for a file stays linear.
    static constexpr std::size_t most_steps = 1 << 22;

    /// Calls triangle(a, b, c) with positions in the polygon, n - 2 times at most. The orientation is kept.
    /// vertices: the number of each corner's vertex; triangles with a repeated vertex are dropped; non_manifold(a, c):
    ///           whether to avoid a diagonal, which is used only as a last resort.
    /// Returns false at the limit of work.
    template <class NonManifold, class Triangle>
    bool split(std::span<const vec3> polygon, std::span<const idx> vertices, NonManifold non_manifold,
               Triangle triangle)
    {
        p_ = polygon;
        vertices_ = vertices;
        start();
        std::size_t left = left_without_repeats();
        std::size_t some = first_; // of the corners that are left
        const auto look = [&](std::size_t i)
        {
            const int own = rank_of(i), rank = own == none || !non_manifold(before_[i], after_[i]) ? own : own + 2;
            ears_.emplace_back(rank, length(i), vertices_[i], i, ++stamp_[i]);
            std::push_heap(ears_.begin(), ears_.end(), std::greater<>());
        };
        const auto look_at_all = [&]
        {
            ears_.clear();
            for (std::size_t k = 0, i = some; k < left && steps_ < most_steps; ++k, i = after_[i]) look(i);
        };
        look_at_all();
        for (bool anew = true; left > 3 && steps_ < most_steps;)
        {
            const auto [rank, length, vertex, i, stamp] = ears_.front();
            std::pop_heap(ears_.begin(), ears_.end(), std::greater<>());
            ears_.pop_back();
            if (stamp != stamp_[i]) continue;
            if (rank >= none && !anew) // what was in the way may have been cut off since
            {
                look_at_all();
                anew = true;
                continue;
            }
            std::size_t cut = i;
            if (rank >= none)
                for (std::size_t k = 0, j = some; k < left && !returns(cut); ++k, j = after_[j])
                    if (returns(j)) cut = j;
            if (returns(cut))
                left -= 2; // the corner, and one of the two that are the same vertex
            else
            {
                triangle(before_[cut], cut, after_[cut]);
                left -= 1;
            }
            const std::size_t a = before_[cut];
            std::size_t c = after_[cut];
            stamp_[cut] = gone;
            if (returns(cut))
            {
                stamp_[c] = gone;
                c = after_[c];
            }
            after_[a] = c;
            before_[c] = a;
            some = a;
            if (left < 3) return true;
            look(a);
            look(c);
            anew = false;
        }
        const bool whole = left <= 3;
        for (; left >= 3; --left)
        {
            const std::size_t b = after_[some], c = after_[b];
            if (!returns(some) && !returns(b) && !returns(c)) triangle(some, b, c);
            after_[some] = c;
            before_[c] = some;
        }
        return whole;
    }

    /// What a fan of triangles from the first corner of a polygon is, seen along the main axis of its normal: how many
    /// programs cut it.
    enum class fan
    {
        convex,  ///< as any other way to cut it: every corner turns left, none of them by less than a millionth
        whole,   ///< positive triangles that do not overlap, although the polygon is not convex
        thin,    ///< the same but for flat triangles
        reversed ///< it has triangles that face away from the polygon, or lie on each other
    };
    fan fan_of(std::span<const vec3> polygon)
    {
        constexpr double thin = 1e-6, turn = 6.2831853;
        p_ = polygon;
        start();
        const auto length = [](const vec2& d) { return glm::dot(d, d); };
        const auto height = [&](const vec2& a, const vec2& b, const vec2& c) {
            return taut::impl::orient(a, b, c).det / std::max({length(b - a), length(c - b), length(a - c)});
        };
        bool convex = true, flat = false;
        for (std::size_t i = 0; i < x_.size(); ++i)
            convex = convex && height(x_[before_[i]], x_[i], x_[after_[i]]) > thin;
        double angle = 0;
        for (std::size_t i = 1; i + 1 < x_.size(); ++i)
        {
            const vec2 b = x_[i] - x_[0], c = x_[i + 1] - x_[0];
            const double own = height(x_[0], x_[i], x_[i + 1]);
            if (own < -thin) return fan::reversed;
            flat = flat || !(own > thin);
            angle += std::atan2(b.x * c.y - b.y * c.x, glm::dot(b, c));
        }
        if (!(angle < turn)) return fan::reversed; // around the first corner more than once
        return convex ? fan::convex : flat ? fan::thin : fan::whole;
    }

private:
    static constexpr int none = 4;                                    // the rank of a corner that is no ear
    static constexpr std::size_t gone = static_cast<std::size_t>(-1); // the stamp of a corner that was cut off

    /// Flattens the polygon along the main axis of its normal, so that it turns counter-clockwise.
    void start()
    {
        const std::size_t n = p_.size();
        x_.resize(n);
        before_.resize(n);
        after_.resize(n);
        stamp_.assign(n, 0);
        steps_ = 0;
        vec3 normal(0.0); // Newell: twice the area vector, also of polygons that are not flat
        for (std::size_t i = 0; i < n; ++i) normal += glm::cross(p_[i] - p_[0], p_[(i + 1) % n] - p_[0]);
        int axis = 2;
        for (int k = 0; k < 2; ++k)
            if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
        const double sign = normal[axis] < 0 ? -1 : 1;
        for (std::size_t i = 0; i < n; ++i)
        {
            x_[i] = vec2(sign * p_[i][(axis + 1) % 3], p_[i][(axis + 2) % 3]);
            before_[i] = (i + n - 1) % n;
            after_[i] = (i + 1) % n;
        }
    }

    /// Removes repeated vertices and spikes. Of the rest, finds those that may lie in an ear: corners that are not
    /// convex, and those at the place of another. Returns how many corners are left.
    std::size_t left_without_repeats()
    {
        std::size_t left = p_.size();
        first_ = 0;
        for (std::size_t i = 1; i < p_.size(); ++i)
        {
            const std::size_t last = before_[i];
            const bool closes = i + 1 == p_.size() && vertices_[i] == vertices_[0];
            if (vertices_[i] != vertices_[last] && !closes) continue;
            after_[last] = after_[i];
            before_[after_[i]] = last;
            stamp_[i] = gone;
            --left;
        }
        for (std::size_t k = 0, i = first_; k < left; ++k, i = after_[i])
            if (const auto [l, r] = foot(i); returns(i) && l != r && !leads_in(l, r))
            {
                for (std::size_t j = after_[l];; j = after_[j])
                {
                    stamp_[j] = gone;
                    --left;
                    if (j == r) break;
                }
                after_[l] = after_[r];
                before_[after_[r]] = l;
                i = first_ = l;
                k = 0;
            }
        order_.clear();
        for (std::size_t i = 0; i < p_.size(); ++i)
            if (stamp_[i] != gone) order_.push_back(i);
        const auto less = [this](std::size_t i, std::size_t j)
        { return x_[i].x < x_[j].x || (x_[i].x == x_[j].x && x_[i].y < x_[j].y); };
        std::sort(order_.begin(), order_.end(), less);
        blockers_.clear();
        for (std::size_t k = 0; k < order_.size(); ++k)
        {
            const std::size_t i = order_[k];
            const bool shared =
                (k > 0 && !less(order_[k - 1], i)) || (k + 1 < order_.size() && !less(i, order_[k + 1]));
            if (shared || taut::impl::orient2d(x_[before_[i]], x_[i], x_[after_[i]]) <= 0) blockers_.push_back(i);
        }
        return left;
    }

    /// Foot of a spike of the outline with tip i, at which the outline goes out and back the same way: the first and
    /// the last corner of that way.
    std::array<std::size_t, 2> foot(std::size_t i) const
    {
        std::size_t l = before_[i], r = after_[i];
        while (l != r && before_[l] != r && vertices_[before_[l]] == vertices_[after_[r]])
            l = before_[l], r = after_[r];
        return {l, r};
    }

    /// Returns whether a way out and back, from corner l to corner r of one vertex, leads into the polygon.
    bool leads_in(std::size_t l, std::size_t r) const
    {
        const vec2 &a = x_[before_[l]], &b = x_[l], &c = x_[after_[r]], &x = x_[after_[l]];
        const bool left_of_first = taut::impl::orient2d(a, b, x) > 0,
                   left_of_second = taut::impl::orient2d(b, c, x) > 0;
        return taut::impl::orient2d(a, b, c) > 0 ? left_of_first && left_of_second : left_of_first || left_of_second;
    }

    double length(std::size_t i) const
    {
        const vec3 d = p_[after_[i]] - p_[before_[i]];
        return glm::dot(d, d);
    }

    /// Returns whether the outline goes to corner i and back.
    bool returns(std::size_t i) const { return vertices_[before_[i]] == vertices_[after_[i]]; }

    /// 0: corner i is an ear. 1: one that is thin, or leaves corners on its diagonal. Those with a non_manifold
    /// diagonal come after them, and what is no ear, whose triangle would lie over others, comes last.
    int rank_of(std::size_t i)
    {
        constexpr double thin = 1e-8; // of what would be left, or is cut off
        const vec2 a = x_[before_[i]], b = x_[i], c = x_[after_[i]];
        const auto whole = taut::impl::orient(a, b, c);
        if (whole.sign <= 0) return none;
        const vec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
        const double diagonal = glm::dot(c - a, c - a);
        int rank = whole.det > thin * std::max({diagonal, glm::dot(b - a, b - a), glm::dot(c - b, c - b)}) ? 0 : 1;
        const double margin = thin * std::sqrt(diagonal);
        steps_ += 1 + blockers_.size();
        for (const std::size_t k : blockers_)
        {
            const vec2& x = x_[k];
            if (x.x < low.x - margin || x.x > high.x + margin || x.y < low.y - margin || x.y > high.y + margin ||
                stamp_[k] == gone || k == before_[i] || k == i || k == after_[i])
                continue;
            const int ab = taut::impl::orient2d(a, b, x), bc = taut::impl::orient2d(b, c, x);
            const auto ca = taut::impl::orient(c, a, x);
            if (ab > 0 && bc > 0 && ca.sign > 0) return none;
            if (ab >= 0 && bc >= 0 && ca.sign >= 0 &&
                (enters({a, b, c}, x, x_[before_[k]]) || enters({a, b, c}, x, x_[after_[k]])))
                return none;
            if (ab > 0 && bc > 0 && ca.det > -thin * diagonal) rank = 1;
        }
        return rank;
    }

    /// Returns whether a segment has a point inside a triangle: no line along one of their sides parts them.
    static bool enters(const std::array<vec2, 3>& t, const vec2& p, const vec2& q)
    {
        for (std::size_t k = 0; k < 3; ++k)
            if (taut::impl::orient2d(t[k], t[(k + 1) % 3], p) <= 0 &&
                taut::impl::orient2d(t[k], t[(k + 1) % 3], q) <= 0)
                return false;
        const int first = taut::impl::orient2d(p, q, t[0]), second = taut::impl::orient2d(p, q, t[1]),
                  third = taut::impl::orient2d(p, q, t[2]);
        return std::min({first, second, third}) < 0 && std::max({first, second, third}) > 0;
    }

    /// Rank, length of the diagonal, vertex (so that copies of a polygon are cut alike), corner, stamp.
    using ear = std::tuple<int, double, idx, std::size_t, std::size_t>;

    std::span<const vec3> p_;
    std::span<const idx> vertices_;
    std::vector<vec2> x_;                     // flattened
    std::vector<std::size_t> before_, after_; // neighbours among the corners that are left
    std::vector<std::size_t> stamp_;          // of the last look at each corner
    std::vector<std::size_t> order_, blockers_;
    std::vector<ear> ears_; // a heap, the best first; outdated where stamps differ
    std::size_t first_ = 0, steps_ = 0;
};

} // namespace taut::io::impl
