// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/charts/atlas/cutting/rest_surface.hpp>

namespace taut::impl
{

/// The sides of least price that part two disjoint sets of triangles of a chart: blocking flows in the dual graph
/// (Dinic 1970), their levels counted from both sets, so that a search ends where the smaller side does. Of several
/// cuts it is the one that is nearest to the set whose search ends first. It can be used again for other sets, at the
/// cost of what flows there.
class minimum_cutting
{
public:
    /// Refers to the surface.
    explicit minimum_cutting(const rest_surface& rest)
        : rest_(rest),
          least_(1e-12 * std::sqrt(rest.total)),
          flow_(rest.price.size(), 0),
          level_(rest.surface.cells().size(), none),
          tried_(level_.size(), 0)
    {
    }

    /// Each edge of the cut by its side on the side of `from`. Empty where seams part them already.
    std::vector<idx> run(std::span<const char> seam, std::span<const idx> from, std::span<const idx> to)
    {
        seam_ = seam;
        for (const idx c : from) level_[u(c)] = 0;
        for (const idx c : to) level_[u(c)] = target;
        start_ = {rim(from), rim(to)};
        while (reach())
            for (const idx c : start_[0]) block_from(c);
        std::vector<idx> cut;
        for (const idx c : queue_[ended_])
            for (idx s = 3 * c; s < 3 * c + 3; ++s)
                if (rest_.twin(s) >= 0 && !seam_[u(s)] && !is_of(ended_, level_[u(rest_.twin(s) / 3)]))
                    cut.push_back(ended_ == 0 ? s : rest_.twin(s));
        forget();
        for (const auto set : {from, to})
            for (const idx c : set) level_[u(c)] = none;
        for (const idx s : full_) flow_[u(s)] = flow_[u(rest_.twin(s))] = 0;
        full_.clear();
        return cut;
    }

private:
    static constexpr idx none = -1, target = -2; // levels: edges from the start, or `target` less those to the target
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// Whether a level is counted from the start (0) or the target (1).
    static bool is_of(std::size_t search, idx level) { return search == 0 ? level > none : level < none; }

    double room(idx s) const { return rest_.twin(s) < 0 || seam_[u(s)] ? 0.0 : rest_.price[u(s)] - flow_[u(s)]; }

    /// The triangles of a set with neighbours that are not of it.
    std::vector<idx> rim(std::span<const idx> set) const
    {
        std::vector<idx> result;
        for (const idx c : set)
            for (idx s = 3 * c; s < 3 * c + 3; ++s)
                if (rest_.twin(s) >= 0 && level_[u(rest_.twin(s) / 3)] != level_[u(c)] &&
                    (result.empty() || result.back() != c))
                    result.push_back(c);
        return result;
    }

    /// Finds the levels of triangles around both sets, one at a time around the set that has fewer, until they meet.
    /// False if they never do, as nothing can flow any more to or from one of them.
    bool reach()
    {
        forget();
        queue_ = start_;
        for (const idx c : start_[0]) level_[u(c)] = 0;
        for (const idx c : start_[1]) level_[u(c)] = target;
        std::array<std::size_t, 2> done{}; // triangles whose neighbours are in the queue
        for (length_ = 1;; ++length_)
        {
            ended_ = queue_[0].size() > queue_[1].size();
            for (const std::size_t k : {ended_, 1 - ended_})
                if (done[k] == queue_[k].size())
                {
                    ended_ = k;
                    return false;
                }
            bool met = false;
            for (const std::size_t end = queue_[ended_].size(); done[ended_] < end; ++done[ended_])
            {
                const idx c = queue_[ended_][done[ended_]];
                for (idx s = 3 * c; s < 3 * c + 3; ++s)
                {
                    if (room(ended_ == 0 || rest_.twin(s) < 0 ? s : rest_.twin(s)) <= least_) continue;
                    const idx next = rest_.twin(s) / 3;
                    met = met || is_of(1 - ended_, level_[u(next)]);
                    if (level_[u(next)] != none) continue;
                    level_[u(next)] = level_[u(c)] + (ended_ == 0 ? 1 : -1);
                    queue_[ended_].push_back(next);
                }
            }
            if (met) return true;
        }
    }

    /// Edges from the start by way of a triangle to the target, where reach() has found that one; else any number.
    idx rank(idx c) const { return level_[u(c)] >= 0 ? level_[u(c)] : length_ + level_[u(c)] - target; }

    /// Undoes what reach() has found.
    void forget()
    {
        for (auto& queue : queue_)
        {
            for (const idx c : queue)
            {
                level_[u(c)] = none;
                tried_[u(c)] = 0;
            }
            queue.clear();
        }
    }

    /// Fills ways from a triangle to targets, each one further at every edge, until there is none left.
    void block_from(idx begin)
    {
        way_.clear();
        for (idx c = begin;;)
        {
            if (level_[u(c)] == target)
            {
                c = fill_way();
                continue;
            }
            unsigned char& k = tried_[u(c)];
            for (; k < 3; ++k)
                if (const idx s = 3 * c + k;
                    room(s) > least_ && level_[u(rest_.twin(s) / 3)] != none && rank(rest_.twin(s) / 3) == rank(c) + 1)
                    break;
            if (k < 3)
            {
                way_.push_back(3 * c + k);
                c = rest_.twin(way_.back()) / 3;
                continue;
            }
            if (way_.empty()) return;
            c = way_.back() / 3; // a dead end
            way_.pop_back();
            ++tried_[u(c)];
        }
    }

    /// Returns where the way ends then: before the first of its edges with least room.
    idx fill_way()
    {
        std::size_t full = 0;
        for (std::size_t i = 1; i < way_.size(); ++i)
            if (room(way_[i]) < room(way_[full])) full = i;
        const double most = room(way_[full]);
        for (const idx s : way_)
        {
            flow_[u(s)] += most;
            flow_[u(rest_.twin(s))] -= most;
            full_.push_back(s);
        }
        const idx c = way_[full] / 3;
        way_.resize(full);
        return c;
    }

    const rest_surface& rest_;
    std::span<const char> seam_;
    double least_;
    std::vector<double> flow_;                      // one a side
    std::vector<idx> level_;                        // one a triangle
    std::vector<unsigned char> tried_;              // sides that lead no further, one a triangle
    std::array<std::vector<idx>, 2> start_, queue_; // of the searches from both sets: where they begin, what they found
    std::size_t ended_ = 0;                         // the search that went on last
    idx length_ = 1;                                // edges of the shortest ways
    std::vector<idx> way_;
    std::vector<idx> full_; // sides that anything has flowed through
};

} // namespace taut::impl
