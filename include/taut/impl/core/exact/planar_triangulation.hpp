// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/errors.hpp>
#include <taut/impl/core/exact/crossings.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// True if d is inside of the circle through a, b, c, a positive triangle, certainly: an exact filter, so that flips by
/// it terminate. False where it is uncertain (Shewchuk 1997 has the bound, used with a margin).
inline bool surely_in_circle(const vec2& a, const vec2& b, const vec2& c, const vec2& d)
{
    const vec2 p = a - d, q = b - d, r = c - d;
    const auto term = [](const vec2& lifted, const vec2& u, const vec2& v)
    {
        const double left = u.x * v.y, right = u.y * v.x, lift = glm::dot(lifted, lifted);
        return std::pair(lift * (left - right), lift * (std::abs(left) + std::abs(right)));
    };
    const auto [pv, ps] = term(p, q, r);
    const auto [qv, qs] = term(q, r, p);
    const auto [rv, rs] = term(r, p, q);
    return pv + qv + rv >
           16 * std::numeric_limits<double>::epsilon() * (ps + qs + rs) + std::numeric_limits<double>::min();
}

/// Incremental triangulation of a rectangle with points, and then fixed edges between them: constrained Delaunay, up to
/// floating point. In exact arithmetic all triangles are positive, they cover the rectangle and no two of them overlap.
///
/// Points one by one, found by walking, edges by flips (Sloan 1993): O(n^1.5) and mostly less.
/// Side s = 3 triangle + k is the edge opposite corner k, with the triangle to its left, as in mesh/facets.hpp.
class planar_triangulation
{
public:
    using triangle_corners = std::array<idx, 3>;
    static constexpr idx none = -1;

    /// Two triangles. Vertices 0 to 3 are the corners, counter-clockwise from `low`. Throws parameter_error.
    planar_triangulation(const vec2& low, const vec2& high)
        : points_{low, {high.x, low.y}, high, {low.x, high.y}}, cells_{{0, 1, 2}, {0, 2, 3}}
    {
        if (!impl::finite(low) || !impl::finite(high) || !(low.x < high.x && low.y < high.y))
            throw parameter_error("rectangle", "must be finite, its lower corner below the upper one");
        twin_ = {none, 5, none, none, none, 1};
        fixed_.assign(6, 0);
        corner_ = {0, 1, 2, 5};
    }

    const std::vector<vec2>& points() const noexcept { return points_; }
    const std::vector<triangle_corners>& cells() const noexcept { return cells_; } ///< counter-clockwise

    idx twin(idx side) const { return twin_[u(side)]; } ///< the side beyond; none: an edge of the rectangle
    bool is_fixed(idx side) const { return fixed_[u(side)] != 0; }

    /// Adds a point; returns its number, or that of the vertex that is there. near: initial vertex of the search.
    /// Throws parameter_error unless it is inside of the rectangle.
    idx add(const vec2& p, idx near)
    {
        if (!impl::finite(p) || !(points_[0].x < p.x && p.x < points_[2].x && points_[0].y < p.y && p.y < points_[2].y))
            throw parameter_error("point", "is not inside of the rectangle; make that larger");
        return insert(p, find(p, corner_[u(near)] / 3, false));
    }
    idx add(const vec2& p) { return add(p, static_cast<idx>(points_.size()) - 1); }

    /// Adds a point unless the search, which begins at a triangle, meets an edge that is fixed, one of the rectangle or
    /// a vertex that is there: then none.
    idx add_from(idx triangle, const vec2& p)
    {
        const idx t = impl::finite(p) ? find(p, triangle, true) : none;
        if (t == none) return none;
        for (std::size_t k = 0; k < 3; ++k)
            if (const idx s = 3 * t + static_cast<idx>(k); turn(s, p) == 0 && (is_fixed(s) || twin(s) == none))
                return none;
        const auto before = points_.size();
        return insert(p, t) == static_cast<idx>(before) ? static_cast<idx>(before) : none;
    }

    /// Makes an edge from a to b and fixes it; where it passes through vertices, it becomes one edge between each two
    /// of them. Throws parameter_error if it crosses one that is fixed; edges made by then stay.
    void fix(idx a, idx b)
    {
        while (a != b) a = fix_first(a, b);
    }

    /// The side from a to b, or none.
    idx side_between(idx a, idx b) const
    {
        idx found = none;
        around(a,
               [&](idx c)
               {
                   if (vertex(next(c)) == b) found = previous(c);
                   return found != none;
               });
        return found;
    }

    /// Calls look(corner) for the corners 3 triangle + k at a vertex until it returns true.
    template <class Look>
    void around(idx v, Look&& look) const
    {
        const idx first = corner_[u(v)];
        for (idx c = first;;)
        {
            if (look(c)) return;
            const idx beyond = twin(next(c));
            if (beyond == none) break;
            c = next(beyond);
            if (c == first) return;
        }
        for (idx beyond = twin(previous(first)); beyond != none;) // a corner of the rectangle: the other way round
        {
            const idx c = previous(beyond);
            if (look(c)) return;
            beyond = twin(previous(c));
        }
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }
    static idx next(idx s) { return s % 3 == 2 ? s - 2 : s + 1; }
    static idx previous(idx s) { return s % 3 == 0 ? s + 2 : s - 1; }

    idx vertex(idx corner) const { return cells_[u(corner / 3)][u(corner % 3)]; }
    const vec2& at(idx v) const { return points_[u(v)]; }
    int turn(idx side, const vec2& p) const { return orient2d(at(vertex(next(side))), at(vertex(previous(side))), p); }

    void join(idx side, idx beyond, char fixed)
    {
        twin_[u(side)] = beyond;
        fixed_[u(side)] = fixed;
        if (beyond == none) return;
        twin_[u(beyond)] = side;
        fixed_[u(beyond)] = fixed;
    }

    void set(idx t, const triangle_corners& corners)
    {
        cells_[u(t)] = corners;
        for (std::size_t k = 0; k < 3; ++k) corner_[u(corners[k])] = 3 * t + static_cast<idx>(k);
    }

    /// Triangle that contains p; none where fixed edges block the walk. Of two sides to leave by one is chosen at
    /// random, as walks among fixed edges could cycle.
    idx find(const vec2& p, idx t, bool barred)
    {
        for (idx from = none;;)
        {
            lots_ = lots_ * 1664525u + 1013904223u;
            idx way = none;
            for (idx k = 0, first = static_cast<idx>(lots_ >> 16) % 3; k < 3 && way == none; ++k)
                if (const idx s = 3 * t + (first + k) % 3; twin(s) != from || from == none)
                    if (turn(s, p) < 0) way = s;
            if (way == none) return t;
            if (twin(way) == none || (barred && is_fixed(way))) return none;
            from = way;
            t = twin(way) / 3;
        }
    }

    /// Inserts p into triangle t.
    idx insert(const vec2& p, idx t)
    {
        idx edge = none; // that p lies on
        for (idx k = 0; k < 3; ++k)
        {
            if (at(vertex(3 * t + k)) == p) return vertex(3 * t + k);
            if (turn(3 * t + k, p) == 0) edge = k;
        }
        const auto m = static_cast<idx>(points_.size());
        points_.push_back(p);
        corner_.push_back(none);
        const auto old = cells_[u(t)];
        std::array<idx, 3> part = {t, static_cast<idx>(cells_.size()), static_cast<idx>(cells_.size()) + 1};
        std::array<idx, 3> beyond;
        std::array<char, 3> fixed;
        for (std::size_t k = 0; k < 3; ++k)
        {
            beyond[k] = twin(3 * t + static_cast<idx>(k));
            fixed[k] = fixed_[u(3 * t) + k];
        }
        cells_.resize(cells_.size() + 2);
        twin_.resize(3 * cells_.size());
        fixed_.resize(3 * cells_.size());
        for (std::size_t k = 0; k < 3; ++k) // (p, q, r): side 0 is that of the triangle
        {
            set(part[k], {m, old[(k + 1) % 3], old[(k + 2) % 3]});
            join(3 * part[k], beyond[k], fixed[k]);
            join(3 * part[k] + 1, 3 * part[(k + 1) % 3] + 2, 0);
        }
        suspects_ = {3 * part[0], 3 * part[1], 3 * part[2]};
        if (edge != none) // its triangle is flat
        {
            const idx flat = 3 * part[u(edge)], other = twin(flat) / 3;
            const bool whole = is_fixed(flat);
            flip(flat);
            for (const idx half : {side_between(m, old[u(edge + 1) % 3]), side_between(m, old[u(edge + 2) % 3])})
                if (whole) join(half, twin(half), 1);
            for (idx k = 0; k < 3; ++k) suspects_.insert(suspects_.end(), {flat + k, 3 * other + k});
        }
        make_delaunay();
        return m;
    }

    /// The other diagonal of the two triangles of an edge; it becomes side 1 of both.
    void flip(idx s)
    {
        const idx o = twin(s), a = vertex(s), p = vertex(next(s)), q = vertex(previous(s)), b = vertex(o);
        const auto outer = [this](idx side) { return std::pair(twin(side), fixed_[u(side)]); };
        const auto qa = outer(next(s)), ap = outer(previous(s)), pb = outer(next(o)), bq = outer(previous(o));
        const idx t = s / 3, r = o / 3;
        set(t, {a, p, b});
        set(r, {b, q, a});
        join(3 * t, pb.first, pb.second);
        join(3 * t + 2, ap.first, ap.second);
        join(3 * r, qa.first, qa.second);
        join(3 * r + 2, bq.first, bq.second);
        join(3 * t + 1, 3 * r + 1, 0);
    }

    /// Flips edges that are certainly not Delaunay, from the suspects on.
    void make_delaunay()
    {
        while (!suspects_.empty())
        {
            const idx s = suspects_.back();
            suspects_.pop_back();
            const idx o = twin(s);
            if (o == none || is_fixed(s)) continue;
            if (!impl::surely_in_circle(at(vertex(s)), at(vertex(next(s))), at(vertex(previous(s))), at(vertex(o))))
                continue;
            const idx t = s / 3, r = o / 3;
            flip(s);
            suspects_.insert(suspects_.end(), {3 * t, 3 * t + 2, 3 * r, 3 * r + 2});
        }
    }

    /// As fix(), up to the first vertex on the way, which is returned.
    idx fix_first(idx a, idx b)
    {
        idx edge = none, crossed = none, end = none;
        const auto on_way = [&](idx v)
        { return v == b || (orient2d(at(a), at(b), at(v)) == 0 && impl::between(at(a), at(b), at(v))); };
        around(a,
               [&](idx c)
               {
                   const idx right = vertex(next(c)), left = vertex(previous(c));
                   if (on_way(right)) edge = previous(c), end = right;
                   if (on_way(left)) edge = next(c), end = left;
                   if (edge != none) return true;
                   if (orient2d(at(a), at(b), at(right)) < 0 && orient2d(at(a), at(b), at(left)) > 0) crossed = c;
                   return crossed != none;
               });
        if (edge == none)
        {
            std::deque<std::array<idx, 2>> in_way;
            while (end == none)
            {
                if (is_fixed(crossed))
                    throw parameter_error("edge", std::to_string(a) + '-' + std::to_string(b) + " crosses edge " +
                                                      std::to_string(vertex(next(crossed))) + '-' +
                                                      std::to_string(vertex(previous(crossed))) +
                                                      ", which is fixed; leave one of them out");
                in_way.push_back({vertex(next(crossed)), vertex(previous(crossed))});
                const idx beyond = twin(crossed);
                const int side = orient2d(at(a), at(b), at(vertex(beyond)));
                if (side == 0)
                    end = vertex(beyond);
                else
                    crossed = side > 0 ? next(beyond) : previous(beyond);
            }
            clear(a, end, std::move(in_way));
            edge = side_between(a, end);
        }
        join(edge, twin(edge), 1);
        make_delaunay();
        return end;
    }

    /// Flips edges until none crosses that from a to b.
    void clear(idx a, idx b, std::deque<std::array<idx, 2>> in_way)
    {
        while (!in_way.empty())
        {
            const idx s = side_between(in_way.front()[0], in_way.front()[1]), o = twin(s);
            const idx c = vertex(s), d = vertex(o);
            const bool convex =
                orient2d(at(c), at(vertex(next(s))), at(d)) > 0 && orient2d(at(d), at(vertex(previous(s))), at(c)) > 0;
            if (!convex)
            {
                in_way.push_back(in_way.front());
                in_way.pop_front();
                continue;
            }
            in_way.pop_front();
            const idx made = 3 * (s / 3) + 1;
            flip(s);
            if (orient2d(at(a), at(b), at(c)) * orient2d(at(a), at(b), at(d)) < 0)
                in_way.push_back({c, d});
            else
                suspects_.push_back(made);
        }
    }

    std::vector<vec2> points_;
    std::vector<triangle_corners> cells_;
    std::vector<idx> twin_;     // one per side
    std::vector<char> fixed_;   // one per side
    std::vector<idx> corner_;   // one per vertex: a corner there
    std::vector<idx> suspects_; // sides to be looked at
    std::uint32_t lots_ = 1;
};

} // namespace taut::impl
