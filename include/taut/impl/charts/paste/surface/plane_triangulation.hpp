// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include <taut/impl/core/exact/predicates.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Counter-clockwise triangles of a part of the plane. Edges are flipped until they are Delaunay, and points inserted;
/// what was the boundary of the part at first stays. Orientations are exact.
class plane_triangulation
{
public:
    plane_triangulation(std::vector<vec2> points, std::vector<std::array<idx, 3>> triangles)
        : x_(std::move(points)), cells_(std::move(triangles)), across_(cells_.size(), {-1, -1, -1})
    {
        std::map<std::array<idx, 2>, std::array<idx, 2>> sides; // of edges, in their direction
        for (idx t = 0; t < size(); ++t)
            for (idx k = 0; k < 3; ++k) sides[{corner(t, k + 1), corner(t, k + 2)}] = {t, k};
        for (const auto& [edge, side] : sides)
            if (const auto twin = sides.find({edge[1], edge[0]}); twin != sides.end())
                across(side[0], side[1]) = twin->second[0];
        std::vector<idx> all(cells_.size());
        for (std::size_t t = 0; t < all.size(); ++t) all[t] = static_cast<idx>(t);
        make_delaunay(std::move(all));
    }

    const std::vector<vec2>& points() const { return x_; }
    const std::vector<std::array<idx, 3>>& triangles() const { return cells_; }

    /// Inserts a point; false, and nothing has changed, where it is outside, on the boundary or on another one.
    bool insert(const vec2& p)
    {
        const idx t = locate(p);
        if (t < 0) return false;
        idx on = -1;
        for (idx k = 0; k < 3; ++k)
            if (orient2d(at(corner(t, k + 1)), at(corner(t, k + 2)), p) == 0)
            {
                if (on >= 0) return false; // a corner
                on = k;
            }
        if (on >= 0 && across(t, on) < 0) return false;
        const auto v = static_cast<idx>(x_.size());
        x_.push_back(p);
        if (on < 0)
            split(t, v);
        else
            split_edge(t, on, v);
        return true;
    }

    /// A triangle that has p inside or on it, by a walk towards it, and if that fails by a search; -1: none.
    idx locate(const vec2& p)
    {
        const auto outside = [&](idx t, idx k) { return orient2d(at(corner(t, k + 1)), at(corner(t, k + 2)), p) < 0; };
        idx t = std::min(last_, size() - 1);
        for (idx steps = 0; steps < size(); ++steps)
        {
            idx out = -1;
            for (idx k = 0; k < 3 && out < 0; ++k)
                if (outside(t, k + steps)) out = (k + steps) % 3;
            if (out < 0) return last_ = t;
            if (across(t, out) < 0) break;
            t = across(t, out);
        }
        for (t = 0; t < size(); ++t)
            if (!outside(t, 0) && !outside(t, 1) && !outside(t, 2)) return last_ = t;
        return -1;
    }

private:
    idx size() const { return static_cast<idx>(cells_.size()); }
    const vec2& at(idx v) const { return x_[static_cast<std::size_t>(v)]; }
    idx& corner(idx t, idx k) { return cells_[static_cast<std::size_t>(t)][static_cast<std::size_t>(k % 3)]; }
    idx corner(idx t, idx k) const { return cells_[static_cast<std::size_t>(t)][static_cast<std::size_t>(k % 3)]; }
    idx& across(idx t, idx k) { return across_[static_cast<std::size_t>(t)][static_cast<std::size_t>(k % 3)]; }

    /// Finds the side of triangle t that is adjacent to triangle u.
    idx side_to(idx t, idx u)
    {
        for (idx k = 0; k < 2; ++k)
            if (across(t, k) == u) return k;
        return 2;
    }

    void set(idx t, std::array<idx, 3> corners, std::array<idx, 3> neighbours)
    {
        cells_[static_cast<std::size_t>(t)] = corners;
        across_[static_cast<std::size_t>(t)] = neighbours;
    }
    idx append()
    {
        cells_.push_back({});
        across_.push_back({-1, -1, -1});
        return size() - 1;
    }
    void relink(idx of, idx from, idx to)
    {
        if (of >= 0) across(of, side_to(of, from)) = to;
    }

    void split(idx t, idx v)
    {
        const auto c = cells_[static_cast<std::size_t>(t)];
        const auto n = across_[static_cast<std::size_t>(t)];
        const idx u = append(), w = append();
        set(t, {v, c[1], c[2]}, {n[0], u, w});
        set(u, {v, c[2], c[0]}, {n[1], w, t});
        set(w, {v, c[0], c[1]}, {n[2], t, u});
        relink(n[1], t, u);
        relink(n[2], t, w);
        make_delaunay({t, u, w});
    }

    void split_edge(idx t, idx k, idx v)
    {
        const idx s = across(t, k), j = side_to(s, t);
        const idx a = corner(t, k), b = corner(t, k + 1), c = corner(t, k + 2), d = corner(s, j);
        const idx tb = across(t, k + 1), tc = across(t, k + 2), sb = across(s, j + 2), sc = across(s, j + 1);
        // t is a b c with the edge b c, s is d c b.
        const idx u = append(), w = append();
        set(t, {a, b, v}, {s, u, tc});
        set(u, {a, v, c}, {w, tb, t});
        set(s, {d, v, b}, {t, sc, w});
        set(w, {d, c, v}, {u, s, sb});
        relink(tb, t, u);
        relink(sb, s, w);
        make_delaunay({t, u, s, w});
    }

    /// Returns whether the angles opposite side k of t and of its neighbour exceed 180 degrees by more than rounding.
    bool wants_flip(idx t, idx k)
    {
        const idx s = across(t, k);
        if (s < 0) return false;
        const vec2 &a = at(corner(t, k)), &b = at(corner(t, k + 1)), &c = at(corner(t, k + 2)),
                   &d = at(corner(s, side_to(s, t)));
        if (orient2d(a, b, d) <= 0 || orient2d(a, d, c) <= 0) return false;
        const auto angle = [](const vec2& from, const vec2& p, const vec2& q)
        {
            const vec2 e = p - from, f = q - from;
            return std::atan2(e.x * f.y - e.y * f.x, glm::dot(e, f));
        };
        return angle(a, b, c) + angle(d, c, b) > 3.141592653589793 + 1e-9;
    }

    void flip(idx t, idx k)
    {
        const idx s = across(t, k), j = side_to(s, t);
        const idx a = corner(t, k), b = corner(t, k + 1), c = corner(t, k + 2), d = corner(s, j);
        const idx tb = across(t, k + 1), tc = across(t, k + 2), sb = across(s, j + 2), sc = across(s, j + 1);
        set(t, {a, b, d}, {sc, s, tc});
        set(s, {a, d, c}, {sb, tb, t});
        relink(tb, t, s);
        relink(sc, s, t);
    }

    void make_delaunay(std::vector<idx> open)
    {
        // Each flip raises the sum of the smallest angles by more than rounding; the bound is for safety's sake.
        for (std::size_t flips = 0, most = 64 * cells_.size() + 1024; !open.empty() && flips < most;)
        {
            const idx t = open.back();
            open.pop_back();
            for (idx k = 0; k < 3; ++k)
            {
                if (!wants_flip(t, k)) continue;
                const idx s = across(t, k);
                flip(t, k);
                ++flips;
                open.insert(open.end(), {s, t});
                break;
            }
        }
    }

    std::vector<vec2> x_;
    std::vector<std::array<idx, 3>> cells_;
    std::vector<std::array<idx, 3>> across_; ///< the triangle opposite each corner, -1: none
    idx last_ = 0;
};

} // namespace taut::impl
