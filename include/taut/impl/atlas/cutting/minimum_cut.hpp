// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <taut/impl/atlas/cutting/rest_surface.hpp>

namespace taut::impl
{

/// The sides of least price that part two disjoint sets of triangles of a chart, with the fewest triangles on the side
/// of `from`: blocking flows in the dual graph (Dinic 1970). It can be used again for other sets, at the cost of what
/// flows there.
class minimum_cutting
{
public:
    /// Refers to the surface.
    explicit minimum_cutting(const rest_surface& rest)
        : rest_(rest),
          least_(1e-12 * std::sqrt(rest.total)),
          flow_(rest.price.size(), 0),
          target_(rest.surface.cells().size(), 0),
          level_(target_.size(), none),
          tried_(target_.size(), 0)
    {
    }

    /// Each edge of the cut by its side on the side of `from`. Empty where seams part them already.
    std::vector<idx> run(std::span<const char> seam, std::span<const idx> from, std::span<const idx> to)
    {
        seam_ = seam;
        from_ = from;
        start_.clear();
        for (const idx c : to) target_[u(c)] = 1;
        for (const idx c : from) level_[u(c)] = 0;
        for (const idx c : from) // those with neighbours that are not among them
            for (idx s = 3 * c; s < 3 * c + 3; ++s)
                if (rest_.twin(s) >= 0 && level_[u(rest_.twin(s) / 3)] == none &&
                    (start_.empty() || start_.back() != c))
                    start_.push_back(c);
        while (reach())
            for (const idx c : start_) block_from(c);
        std::vector<idx> cut;
        for (const idx c : queue_)
            for (idx s = 3 * c; s < 3 * c + 3; ++s)
                if (rest_.twin(s) >= 0 && !seam_[u(s)] && level_[u(rest_.twin(s) / 3)] == none) cut.push_back(s);
        forget();
        for (const idx c : from) level_[u(c)] = none;
        for (const idx c : to) target_[u(c)] = 0;
        for (const idx s : full_) flow_[u(s)] = flow_[u(rest_.twin(s))] = 0;
        full_.clear();
        return cut;
    }

private:
    static constexpr idx none = -1;
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    double room(idx s) const { return rest_.twin(s) < 0 || seam_[u(s)] ? 0.0 : rest_.price[u(s)] - flow_[u(s)]; }

    /// Finds the number of edges to all triangles that flow can still reach, up to the nearest target. False if none is
    /// reached.
    bool reach()
    {
        forget();
        queue_ = start_;
        for (const idx c : from_) level_[u(c)] = 0;
        idx last = std::numeric_limits<idx>::max();
        for (std::size_t i = 0; i < queue_.size() && level_[u(queue_[i])] < last; ++i)
            for (idx s = 3 * queue_[i]; s < 3 * queue_[i] + 3; ++s)
            {
                if (room(s) <= least_) continue;
                const idx c = rest_.twin(s) / 3;
                if (level_[u(c)] != none) continue;
                level_[u(c)] = level_[u(queue_[i])] + 1;
                queue_.push_back(c);
                if (target_[u(c)]) last = level_[u(c)];
            }
        return last < std::numeric_limits<idx>::max();
    }

    /// Undoes what reach() has found.
    void forget()
    {
        for (const idx c : queue_)
        {
            level_[u(c)] = none;
            tried_[u(c)] = 0;
        }
        queue_.clear();
    }

    /// Fills ways from a triangle to targets, each one level further at every edge, until there is none left.
    void block_from(idx begin)
    {
        way_.clear();
        for (idx c = begin;;)
        {
            if (target_[u(c)])
            {
                c = fill_way();
                continue;
            }
            unsigned char& k = tried_[u(c)];
            for (; k < 3; ++k)
                if (const idx s = 3 * c + k; room(s) > least_ && level_[u(rest_.twin(s) / 3)] == level_[u(c)] + 1)
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
    std::span<const idx> from_;
    double least_;
    std::vector<double> flow_;         // one a side
    std::vector<char> target_;         // one a triangle
    std::vector<idx> level_;           // edges from the start, one a triangle
    std::vector<unsigned char> tried_; // sides that lead no further, one a triangle
    std::vector<idx> start_, queue_, way_;
    std::vector<idx> full_; // sides that anything has flowed through
};

} // namespace taut::impl
