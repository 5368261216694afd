// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/hierarchy/thinning.hpp>

namespace taut::impl
{

thinning::thinning(thinning_surface surface, unsigned threads) : surface_(std::move(surface)), threads_(threads)
{
    const std::size_t n = surface_.points.size();
    key_.assign(n, removal_key::never);
    size_.assign(n, 0);
    round_.of.assign(n, -1);
    where_.resize(n);
    for (std::size_t v = 0; v < n; ++v)
    {
        const auto id = static_cast<idx>(v);
        if (surface_.rings.ranges[v].size == 0) continue;
        alive_.push_back(id);
        where_[v] = {{id, id, id}, {1, 0, 0}};
    }
    log_.rounds = {0};
    log_.rings.offsets = {0};
    for_alive([&](idx v) { size_[static_cast<std::size_t>(v)] = star_size(surface_, v, surface_.rings[v]); });
    double sum = 0;
    for (const idx v : alive_) sum += static_cast<double>(size_[static_cast<std::size_t>(v)]);
    whole_ = sum;
}

void thinning::run(std::size_t goal, const std::function<bool()>& proceed)
{
    // When few qualify the rules are relaxed, for the rest of the level.
    constexpr collapse_rules strictness[] = {{0.12, 4, 0.6, false},
                                             {0.12, 16, 0.6, false},
                                             {0.06, 1e30, 0.5, false},
                                             {0.02, 1e30, 0.4, true},
                                             {0.002, 1e30, 0.3, true}};
    std::size_t stage = 0;
    while (alive_.size() > goal)
    {
        if (proceed && !proceed()) return;
        const std::size_t before = alive_.size();
        round(goal, strictness[stage]);
        if (static_cast<double>(before - alive_.size()) > 0.05 * static_cast<double>(before)) continue;
        if (++stage == std::size(strictness)) return;
        std::fill(stubborn_.begin(), stubborn_.end(), 0);
    }
}

std::pair<prolongation<3>, removals<triangle>> thinning::result()
{
    std::vector<idx> number(surface_.points.size(), 0);
    for (std::size_t i = 0; i < alive_.size(); ++i) number[static_cast<std::size_t>(alive_[i])] = static_cast<idx>(i);
    prolongation<3> P;
    P.columns.resize(where_.size());
    P.weights.resize(where_.size());
    parallel_for(
        where_.size(),
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t i = begin; i < end; ++i)
            {
                P.weights[i] = where_[i].weights;
                idx used = 0;
                for (std::size_t k = 0; k < 3; ++k)
                    if (P.weights[i][k] > 0) used = number[static_cast<std::size_t>(where_[i].vertices[k])];
                for (std::size_t k = 0; k < 3; ++k)
                    P.columns[i][k] =
                        P.weights[i][k] > 0 ? number[static_cast<std::size_t>(where_[i].vertices[k])] : used;
            }
        },
        threads_);
    transpose(P, alive_.size(), threads_);
    return {std::move(P), std::move(log_)};
}

thinning_surface thinning::coarse() const
{
    std::vector<idx> number(surface_.points.size(), 0);
    thinning_surface c;
    const std::size_t n = alive_.size();
    c.rings.ranges.resize(n);
    idx items = 0;
    for (std::size_t i = 0; i < n; ++i)
    {
        const auto v = static_cast<std::size_t>(alive_[i]);
        number[v] = static_cast<idx>(i);
        c.rings.ranges[i] = {items, surface_.rings.ranges[v].size};
        items += surface_.rings.ranges[v].size;
    }
    c.rings.items.resize(static_cast<std::size_t>(items));
    c.points.resize(n);
    c.open.resize(n);
    c.keep.resize(n);
    parallel_for(
        n,
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t i = begin; i < end; ++i)
            {
                const auto v = static_cast<std::size_t>(alive_[i]);
                c.points[i] = surface_.points[v];
                c.open[i] = surface_.open[v];
                c.keep[i] = surface_.keep[v];
                idx* out = c.rings.items.data() + c.rings.ranges[i].first;
                for (const idx w : surface_.rings[alive_[i]]) *out++ = number[static_cast<std::size_t>(w)];
            }
        },
        threads_);
    return c;
}

void thinning::limit(std::size_t most)
{
    const auto left =
        std::count_if(round_.collapses.begin(), round_.collapses.end(), [](const auto& c) { return c.target >= 0; });
    if (static_cast<std::size_t>(left) <= most) return;
    std::vector<std::pair<std::uint32_t, std::size_t>> ranked;
    for (std::size_t i = 0; i < round_.collapses.size(); ++i)
        if (round_.collapses[i].target >= 0)
            ranked.emplace_back(key_[static_cast<std::size_t>(round_.collapses[i].vertex)], i);
    std::nth_element(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(most), ranked.end());
    for (std::size_t r = most; r < ranked.size(); ++r) give_up(ranked[r].second);
}

void thinning::write_log()
{
    const auto& collapses = round_.collapses;
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < collapses.size(); ++i)
    {
        if (collapses[i].target < 0) continue;
        kept.push_back(i);
        log_.rings.offsets.push_back(log_.rings.offsets.back() + round_.first_corner[i + 1] - round_.first_corner[i]);
    }
    const std::size_t first = log_.vertex.size();
    log_.vertex.resize(first + kept.size());
    log_.target.resize(first + kept.size());
    log_.open.resize(first + kept.size());
    log_.rings.items.resize(static_cast<std::size_t>(log_.rings.offsets.back()));
    parallel_for(
        kept.size(),
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t k = begin; k < end; ++k)
            {
                const auto& c = collapses[kept[k]];
                log_.vertex[first + k] = c.vertex;
                log_.target[first + k] = c.target;
                log_.open[first + k] = surface_.open[static_cast<std::size_t>(c.vertex)];
                const auto ring = surface_.rings[c.vertex];
                std::copy(ring.begin(), ring.end(), log_.rings.items.begin() + log_.rings.offsets[first + k]);
            }
        },
        threads_);
    log_.rounds.push_back(static_cast<idx>(log_.vertex.size()));
}

} // namespace taut::impl
