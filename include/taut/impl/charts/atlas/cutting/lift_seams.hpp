// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/cutting/flat_surface.hpp>

namespace taut::impl
{

/// Leads seams of a coarse surface over the surface that it was made of: each edge becomes a shortest way between its
/// two vertices that meets no other seam.
class seam_lifting
{
public:
    /// sides, price: starting_sides() and one a side of the fine surface m, whose facets are `f`
    seam_lifting(const mesh<triangle>& m, const facet_table& f, const csr& sides, std::span<const double> price)
        : mesh_(m),
          facets_(f),
          sides_(sides),
          price_(price),
          used_(m.points().size(), 0),
          distance_(m.points().size(), std::numeric_limits<double>::infinity()),
          came_(m.points().size(), -1),
          seam_(f.twin.size(), 0)
    {
        for (std::size_t s = 0; s < f.twin.size(); ++s)
            if (f.twin[s] < 0) used_[u(vertex(static_cast<idx>(s), 1))] = used_[u(vertex(static_cast<idx>(s), 2))] = 1;
        for (std::size_t s = 0; s < f.twin.size(); ++s)
            least_ = std::min(least_, price[s] / glm::distance(m.points()[u(vertex(static_cast<idx>(s), 1))],
                                                               m.points()[u(vertex(static_cast<idx>(s), 2))]));
    }

    /// origins: the vertex here of each coarse vertex; those that have none, in holes, are left out.
    std::vector<char> run(const rest_surface& coarse, std::span<const char> seam, std::span<const idx> origins)
    {
        const auto n = static_cast<idx>(origins.size());
        std::vector<idx> edges;
        for (std::size_t s = 0; s < seam.size(); ++s)
        {
            const auto side = static_cast<idx>(s);
            if (!seam[s] || coarse.twin(side) < side) continue;
            for (const idx v : {coarse.start(side), coarse.end(side)})
                if (v < n) used_[u(origins[u(v)])] = 1;
            if (coarse.start(side) < n && coarse.end(side) < n) edges.push_back(side);
        }
        // What is short has few ways, and goes first.
        std::stable_sort(edges.begin(), edges.end(),
                         [&](idx a, idx b) { return coarse.length[u(a)] < coarse.length[u(b)]; });
        for (const idx s : edges)
        {
            const idx from = origins[u(coarse.start(s))], to = origins[u(coarse.end(s))];
            if (!lead(from, to, true)) lead(from, to, false);
        }
        return std::move(seam_);
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }
    idx vertex(idx side, idx turn) const { return mesh_.cells()[u(side / 3)][u((side % 3 + turn) % 3)]; }

    /// Dijkstra's algorithm, with the straight distance that is left as a bound. Marks the way.
    bool lead(idx from, idx to, bool apart)
    {
        using entry = std::pair<double, idx>;
        std::priority_queue<entry, std::vector<entry>, std::greater<>> queue;
        const vec3 goal = mesh_.points()[u(to)];
        touched_.clear();
        const auto reach = [&](double there, idx side, idx w)
        {
            if ((apart && used_[u(w)] && w != to) || !(there < distance_[u(w)])) return;
            if (distance_[u(w)] == std::numeric_limits<double>::infinity()) touched_.push_back(w);
            distance_[u(w)] = there;
            came_[u(w)] = side;
            queue.emplace(there + glm::distance(mesh_.points()[u(w)], goal) * least_, w);
        };
        distance_[u(from)] = 0;
        touched_.push_back(from);
        queue.emplace(glm::distance(mesh_.points()[u(from)], goal) * least_, from);
        bool found = false;
        while (!queue.empty())
        {
            const auto [bound, v] = queue.top();
            queue.pop();
            if (v == to)
            {
                found = true;
                break;
            }
            const double here = distance_[u(v)];
            if (bound > here + glm::distance(mesh_.points()[u(v)], goal) * least_ * (1 + 1e-12)) continue;
            for (const idx s : sides_.row(v))
            {
                reach(here + price_[u(s)], s, vertex(s, 2));
                const idx before = s % 3 == 0 ? s + 2 : s - 1;
                if (facets_.twin[u(before)] < 0) reach(here + price_[u(before)], before, vertex(before, 1));
            }
        }
        if (found)
            for (idx v = to; v != from;)
            {
                const idx s = came_[u(v)];
                if (facets_.twin[u(s)] >= 0) seam_[u(s)] = seam_[u(facets_.twin[u(s)])] = 1;
                v = vertex(s, 1) == v ? vertex(s, 2) : vertex(s, 1);
                used_[u(v)] = 1;
            }
        for (const idx v : touched_) distance_[u(v)] = std::numeric_limits<double>::infinity();
        return found;
    }

    const mesh<triangle>& mesh_;
    const facet_table& facets_;
    const csr& sides_;
    std::span<const double> price_;
    std::vector<char> used_; // one a vertex: of a seam, or of the boundary
    std::vector<double> distance_;
    std::vector<idx> came_, touched_;
    std::vector<char> seam_;
    double least_ = 1; // of a price by its length
};

} // namespace taut::impl
