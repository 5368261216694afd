// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/exact/predicates.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Rank of the simplices around a vertex: fewer that are not positive first, then the smallest determinant.
struct star_rank
{
    std::size_t defects = 0;
    double least = std::numeric_limits<double>::infinity();

    bool better_than(const star_rank& o) const { return defects != o.defects ? defects < o.defects : least > o.least; }
};

template <int D>
class rounding_repair
{
public:
    using simplex = std::array<idx, D + 1>;

    rounding_repair(std::span<const simplex> cells, std::span<vec<D>> x) : cells_(cells), x_(x), stars_(x.size())
    {
        for (std::size_t c = 0; c < cells.size(); ++c)
            for (const idx v : cells[c]) stars_[static_cast<std::size_t>(v)].push_back(c);
    }

    /// Moves the vertices of simplices that are not positive, and if that fails those around them, too, until none is
    /// left or nothing changes.
    template <class Movable>
    void run(const Movable& movable)
    {
        constexpr int rounds = 40;
        constexpr std::size_t most_rings = 3;
        std::size_t rings = 0, before = cells_.size();
        for (int round = 0; round < rounds; ++round)
        {
            std::vector<std::size_t> bad;
            for (std::size_t c = 0; c < cells_.size(); ++c)
                if (judge(c).sign <= 0) bad.push_back(c);
            if (bad.empty()) return;
            rings = bad.size() < before ? 0 : std::min(rings + 1, most_rings);
            before = bad.size();
            bool changed = false;
            for (const std::size_t v : around(std::move(bad), rings)) changed = improve(v, movable) || changed;
            if (!changed && rings == most_rings) return;
        }
    }

private:
    template <std::size_t... K>
    orientation judge(std::size_t c, std::index_sequence<K...>) const
    {
        return orient(x_[static_cast<std::size_t>(cells_[c][K])]...);
    }
    orientation judge(std::size_t c) const { return judge(c, std::make_index_sequence<D + 1>{}); }

    /// Vertices of some simplices, and of some rings around these.
    std::vector<std::size_t> around(std::vector<std::size_t> simplices, std::size_t rings) const
    {
        std::vector<char> seen(x_.size(), 0);
        std::vector<std::size_t> vertices;
        for (std::size_t ring = 0;; ++ring)
        {
            const std::size_t first = vertices.size();
            for (const std::size_t c : simplices)
                for (const idx v : cells_[c])
                    if (!std::exchange(seen[static_cast<std::size_t>(v)], 1))
                        vertices.push_back(static_cast<std::size_t>(v));
            if (ring == rings) return vertices;
            simplices.clear();
            for (std::size_t k = first; k < vertices.size(); ++k)
                simplices.insert(simplices.end(), stars_[vertices[k]].begin(), stars_[vertices[k]].end());
        }
    }

    star_rank rank(std::size_t v) const
    {
        star_rank r;
        for (const std::size_t c : stars_[v])
        {
            const auto o = judge(c);
            r.defects += o.sign <= 0;
            r.least = std::min(r.least, o.det);
        }
        return r;
    }

    /// Moves a vertex to the best position within a few units of its last digits.
    template <class Movable>
    bool improve(std::size_t v, const Movable& movable)
    {
        const vec<D> from = x_[v];
        vec<D> best = from;
        star_rank reached = rank(v);
        for (const int reach : {1, 2, 4})
        {
            int offset[D];
            const int places = D == 2 ? 9 : 27;
            for (int place = 0; place < places; ++place)
            {
                vec<D> to = from;
                bool allowed = true;
                for (int k = 0, rest = place; k < D; ++k, rest /= 3)
                {
                    offset[k] = (rest % 3 - 1) * reach;
                    if (offset[k] != 0) allowed = allowed && movable(v, k);
                    to[k] = moved(from[k], offset[k]);
                }
                if (!allowed) continue;
                x_[v] = to;
                if (const auto r = rank(v); r.better_than(reached)) reached = r, best = to;
            }
            if (reached.defects == 0) break;
        }
        x_[v] = best;
        return best != from;
    }

    /// Adds a number of units in the last place of single precision.
    static double moved(double x, int steps)
    {
        auto y = static_cast<float>(x);
        const float towards = std::copysign(std::numeric_limits<float>::infinity(), static_cast<float>(steps));
        for (int i = 0; i < std::abs(steps); ++i) y = std::nextafter(y, towards);
        return std::isfinite(y) ? static_cast<double>(y) : x;
    }

    std::span<const simplex> cells_;
    std::span<vec<D>> x_;
    std::vector<std::vector<std::size_t>> stars_;
};

/// Moves vertices whose coordinates are numbers of single precision by a few units of their last digit, where that
/// makes more simplices positive around them: rounding has flattened some, or inverted them.
///
/// cells: #F by D + 1 vertex indices, in range; x: one point per vertex; movable(v, k): coordinate k of v may change
template <int D, class Movable>
void mend_rounding(std::span<const std::array<idx, D + 1>> cells, std::span<vec<D>> x, const Movable& movable)
{
    impl::rounding_repair<D>(cells, x).run(movable);
}

} // namespace taut::impl
