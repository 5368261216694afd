// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <utility>

#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/impl/core/sparse/elimination_solver.hpp>
#include <taut/impl/core/start/make_barycentric_system.hpp>
#include <taut/impl/core/start/outline.hpp>
#include <taut/impl/core/start/tube_map.hpp>

namespace taut::impl
{

/// Rings and rays of a tube, a surface whose holes but the one at its end are filled.
class tube_rings
{
public:
    /// Refers to all. outline and end: boundary loops.
    tube_rings(const mesh<triangle>& tube, const std::vector<idx>& outline, const std::vector<idx>& end,
               elimination_solver& solver)
        : tube_(tube), outline_(outline), end_(end), solver_(solver), near_(vertex_neighbours(tube))
    {
        for (const auto& t : tube.cells())
            area_ += 0.5 * glm::length(glm::cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])));
        find_path();
    }

    /// Length along a path from end to end by the mean circumference; 0 where there is no path.
    double slenderness() const
    {
        double length = 0;
        for (std::size_t k = 1; k < path_.size(); ++k) length += glm::distance(at(path_[k]), at(path_[k - 1]));
        return length * length / area_;
    }

    /// Places of all vertices; triangles may be flipped.
    std::vector<vec2> places()
    {
        weigh();
        const auto along = harmonic_along(), around = harmonic_around();
        const auto [levels, lengths] = length_by_level(along);
        const double length = lengths.back(), circumference = area_ / length;
        // The energy of rings whose radii grow by a constant is least there.
        const double slope = std::sqrt(circumference * std::numbers::sqrt3 / (2 * std::numbers::pi * length));
        std::vector<vec2> x(along.size());
        for (std::size_t v = 0; v < x.size(); ++v)
        {
            const auto above = static_cast<std::size_t>(
                std::upper_bound(levels.begin() + 1, levels.end() - 1, along[v]) - levels.begin());
            const double part = (along[v] - levels[above - 1]) / (levels[above] - levels[above - 1]);
            const double here = std::lerp(lengths[above - 1], lengths[above], std::clamp(part, 0.0, 1.0));
            x[v] = slope * (here + circumference / (2 * std::numbers::pi)) *
                   vec2(std::cos(around[v]), std::sin(around[v]));
        }
        return x;
    }

private:
    static std::size_t u(idx v) { return static_cast<std::size_t>(v); }
    const vec3& at(idx v) const { return tube_.points()[u(v)]; }

    /// A path of fewest edges from the end to the outline.
    void find_path()
    {
        std::vector<idx> from(tube_.points().size(), -1), reached = end_;
        for (const idx v : end_) from[u(v)] = v;
        std::vector<char> goal(from.size(), 0);
        for (const idx v : outline_) goal[u(v)] = 1;
        for (std::size_t k = 0; k < reached.size(); ++k)
        {
            idx v = reached[k];
            if (goal[u(v)])
            {
                for (path_ = {v}; from[u(v)] != v; path_.push_back(v)) v = from[u(v)];
                std::reverse(path_.begin(), path_.end());
                return;
            }
            for (const idx w : near_.row(v))
                if (from[u(w)] < 0)
                {
                    from[u(w)] = v;
                    reached.push_back(w);
                }
        }
    }

    std::size_t slot(idx v, idx w) const
    {
        const auto row = near_.row(v);
        return u(near_.offsets[u(v)]) +
               static_cast<std::size_t>(std::lower_bound(row.begin(), row.end(), w) - row.begin());
    }

    /// Cotangents as weights of edges, positive ones.
    void weigh()
    {
        weights_.assign(near_.items.size(), 0);
        for (const auto& t : tube_.cells())
            for (std::size_t k = 0; k < 3; ++k)
            {
                const idx a = t[(k + 1) % 3], b = t[(k + 2) % 3];
                const vec3 p = at(a) - at(t[k]), q = at(b) - at(t[k]);
                const double cotangent = glm::dot(p, q) / glm::length(glm::cross(p, q));
                if (!std::isfinite(cotangent)) continue;
                weights_[slot(a, b)] += cotangent / 2;
                weights_[slot(b, a)] += cotangent / 2;
            }
        double mean = 0;
        for (const double w : weights_) mean += std::abs(w) / static_cast<double>(weights_.size());
        for (double& w : weights_) w = std::max(w, 1e-3 * mean);
    }

    /// Solves for the mean of neighbours at all vertices that are not fixed. shifts: what the value of a neighbour, by
    /// edge, differs from that of its vertex.
    std::vector<double> solve(const std::vector<char>& fixed, std::vector<double> x, std::span<const double> shifts)
    {
        barycentric_system system;
        std::vector<idx> row_of(x.size(), -1);
        for (std::size_t v = 0; v < x.size(); ++v)
            if (!fixed[v] && !near_.row(static_cast<idx>(v)).empty())
            {
                row_of[v] = static_cast<idx>(system.unknown.size());
                system.unknown.push_back(static_cast<idx>(v));
            }
        for (const idx v : system.unknown)
        {
            double excess = 0, right = 0;
            for (auto k = u(near_.offsets[u(v)]); k < u(near_.offsets[u(v) + 1]); ++k)
            {
                const std::size_t to = u(near_.items[k]);
                if (!shifts.empty()) right += weights_[k] * shifts[k];
                if (fixed[to])
                {
                    excess += weights_[k];
                    right += weights_[k] * x[to];
                    continue;
                }
                system.column.push_back(row_of[to]);
                system.weight.push_back(weights_[k]);
            }
            system.excess.push_back(excess);
            system.rhs.emplace_back(right, 0);
            system.offset.push_back(static_cast<idx>(system.column.size()));
        }
        const auto found = solver_(system);
        for (std::size_t i = 0; i < found.size(); ++i) x[u(system.unknown[i])] = found[i].x;
        return x;
    }

    /// 0 at the end, 1 at the outline.
    std::vector<double> harmonic_along()
    {
        std::vector<char> fixed(tube_.points().size(), 0);
        std::vector<double> x(fixed.size(), 0);
        for (const idx v : end_) fixed[u(v)] = 1;
        for (const idx v : outline_) fixed[u(v)] = 1, x[u(v)] = 1;
        return solve(fixed, std::move(x), {});
    }

    /// Angles, which differ by a turn across the path.
    std::vector<double> harmonic_around()
    {
        constexpr double turn = 2 * std::numbers::pi;
        std::vector<double> shifts(near_.items.size(), 0);
        const auto cross = [&](idx v, idx w)
        {
            shifts[slot(v, w)] = turn;
            shifts[slot(w, v)] = -turn;
        };
        const csr corners = vertex_corners(tube_);
        for (std::size_t k = 0; k < path_.size(); ++k)
        {
            const idx v = path_[k], before = k > 0 ? path_[k - 1] : -1,
                      after = k + 1 < path_.size() ? path_[k + 1] : -1;
            std::map<idx, idx> next, last; // neighbours, counter-clockwise and clockwise
            for (const idx c : corners.row(v))
            {
                const auto& t = tube_.cells()[u(c / 3)];
                const idx a = t[u(c % 3 + 1) % 3], b = t[u(c % 3 + 2) % 3];
                next[a] = b;
                last[b] = a;
            }
            // To the left of the path: from the vertex after to the one before.
            const auto& way = after >= 0 ? next : last;
            const idx stop = after >= 0 ? before : after;
            auto w = way.find(after >= 0 ? after : before);
            for (std::size_t most = near_.row(v).size(); w != way.end() && w->second != stop && most > 0; --most)
            {
                cross(v, w->second);
                w = way.find(w->second);
            }
        }
        std::vector<char> fixed(tube_.points().size(), 0);
        fixed[u(path_.front())] = 1;
        return solve(fixed, std::vector<double>(fixed.size(), 0), shifts);
    }

    /// Levels of the function along, ascending, and the length of the tube up to each: the flux through all rings is
    /// one, so that the area between two tells their distance.
    std::pair<std::vector<double>, std::vector<double>> length_by_level(const std::vector<double>& along) const
    {
        double flux = 0;
        for (idx v = 0; v < tube_.vertex_count(); ++v)
            for (auto k = u(near_.offsets[u(v)]); k < u(near_.offsets[u(v) + 1]); ++k)
                flux += 0.5 * weights_[k] * std::pow(along[u(v)] - along[u(near_.items[k])], 2);
        auto sorted = along;
        std::sort(sorted.begin(), sorted.end());
        const auto bins = std::max<std::size_t>(8, static_cast<std::size_t>(4 * slenderness()));
        std::vector<double> levels{0};
        for (std::size_t b = 1; b < bins; ++b)
            if (const double level = sorted[b * (sorted.size() - 1) / bins]; level > levels.back() && level < 1)
                levels.push_back(level);
        levels.push_back(1);
        std::vector<double> areas(levels.size(), 0), lengths(levels.size(), 0);
        for (const auto& t : tube_.cells())
        {
            const double area = 0.5 * glm::length(glm::cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])));
            const auto [low, high] = std::minmax({along[u(t[0])], along[u(t[1])], along[u(t[2])]});
            const auto below = [&, low = low, high = high](double level) {
                return high > low ? std::clamp((level - low) / (high - low), 0.0, 1.0) : level >= low ? 1.0 : 0.0;
            };
            auto b =
                static_cast<std::size_t>(std::upper_bound(levels.begin() + 1, levels.end() - 1, low) - levels.begin());
            for (double done = 0; done < 1 && b < levels.size(); ++b)
            {
                const double now = b + 1 == levels.size() ? 1.0 : below(levels[b]);
                areas[b] += (now - done) * area;
                done = now;
            }
        }
        for (std::size_t b = 1; b < levels.size(); ++b)
            lengths[b] = lengths[b - 1] + std::sqrt(areas[b] * (levels[b] - levels[b - 1]) / flux);
        return {std::move(levels), std::move(lengths)};
    }

    const mesh<triangle>& tube_;
    const std::vector<idx>&outline_, &end_;
    elimination_solver& solver_;
    csr near_;
    std::vector<double> weights_; ///< of the neighbours
    std::vector<idx> path_;       ///< from the end to the outline
    double area_ = 0;
};

/// The loop that is farthest from the outline, by edges.
inline std::size_t farthest_loop(const mesh<triangle>& m, std::span<const std::vector<idx>> loops, std::size_t outline)
{
    const csr near = vertex_neighbours(m);
    std::vector<idx> steps(m.points().size(), -1), reached = loops[outline];
    for (const idx v : reached) steps[static_cast<std::size_t>(v)] = 0;
    for (std::size_t k = 0; k < reached.size(); ++k)
        for (const idx w : near.row(reached[k]))
            if (idx& s = steps[static_cast<std::size_t>(w)]; s < 0)
            {
                s = steps[static_cast<std::size_t>(reached[k])] + 1;
                reached.push_back(w);
            }
    std::size_t best = outline;
    idx most = -1;
    for (std::size_t l = 0; l < loops.size(); ++l)
    {
        if (l == outline) continue;
        idx least = steps[static_cast<std::size_t>(loops[l][0])];
        for (const idx v : loops[l]) least = std::min(least, steps[static_cast<std::size_t>(v)]);
        if (least > most) best = l, most = least;
    }
    return best;
}

/// Returns whether a surface is no tube for sure, but a sheet: it has little area for the length of its outline.
inline bool is_wide(const mesh<triangle>& m, const std::vector<idx>& outline)
{
    const auto at = [&m](idx v) { return m.points()[static_cast<std::size_t>(v)]; };
    double length = 0, area = 0;
    for (std::size_t k = 0; k < outline.size(); ++k)
        length += glm::distance(at(outline[k]), at(outline[(k + 1) % outline.size()]));
    for (const auto& t : m.cells()) area += 0.5 * glm::length(glm::cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])));
    return !(area > 0.5 * length * length);
}

std::vector<vec2> tube_map(const mesh<triangle>& m, std::span<const std::vector<idx>> loops,
                           const std::function<bool()>& proceed)
{
    constexpr double slender = 5; // below that other maps are as good
    if (loops.size() < 2) return {};
    const std::size_t outline = longest_loop(m.points(), loops);
    if (is_wide(m, loops[outline])) return {};
    const std::size_t end = farthest_loop(m, loops, outline);
    auto points = m.points();
    auto cells = m.cells();
    for (std::size_t l = 0; l < loops.size(); ++l)
        if (l != outline && l != end) span_hole(loops[l], points, cells);
    const mesh<triangle> tube(points, cells);
    elimination_solver solver;
    solver.proceed = proceed;
    tube_rings rings(tube, loops[outline], loops[end], solver);
    if (!(rings.slenderness() > slender)) return {};

    auto x = rings.places();
    const auto corner = [&x](idx v) -> vec2& { return x[static_cast<std::size_t>(v)]; };
    const bool crossed =
        std::any_of(m.cells().begin(), m.cells().end(),
                    [&](const auto& t) { return orient2d(corner(t[0]), corner(t[1]), corner(t[2])) <= 0; });
    if (crossed)
    {
        points.clear();
        for (const vec2& p : x) points.emplace_back(p, 0);
        span_hole(loops[end], points, cells);
        x.resize(points.size());
        std::vector<char> fixed(points.size(), 0);
        for (const idx v : loops[outline]) fixed[static_cast<std::size_t>(v)] = 1;
        const auto system = make_barycentric_system(points, cells, fixed, x, barycentric_weights::mean_value);
        elimination_solver again;
        again.proceed = proceed;
        const auto found = again(system);
        for (std::size_t i = 0; i < found.size(); ++i) corner(system.unknown[i]) = found[i];
    }
    x.resize(m.points().size());
    return x;
}

} // namespace taut::impl
