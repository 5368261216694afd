// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/hierarchy/independent_set.hpp>
#include <taut/impl/core/hierarchy/prolongation.hpp>
#include <taut/impl/core/hierarchy/removals.hpp>
#include <taut/impl/core/hierarchy/tracking.hpp>

namespace taut::impl
{

/// Coarsens a surface in rounds of independent half-edge collapses (Dobkin, Kirkpatrick 1985), tracking each removed
/// vertex on the remaining surface (MAPS: Lee, Sweldens, Schroeder, Cowsar, Dobkin 1998). The numbering of the original
/// surface is kept. The result does not depend on the number of threads.
class thinning
{
public:
    thinning(thinning_surface surface, unsigned threads);

    std::size_t alive() const { return alive_.size(); }

    /// Removes vertices until `goal` remain, hardly any can be removed, or proceed(), if given, returns false.
    void run(std::size_t goal, const std::function<bool()>& proceed = {});

    /// Result of run(). Afterwards only coarse() may be called.
    std::pair<prolongation<3>, removals<triangle>> result();

    /// Remaining vertices, ascending; the numbering of the coarse surface.
    const std::vector<idx>& remaining() const { return alive_; }

    /// Remaining surface, renumbered.
    thinning_surface coarse() const;

private:
    template <class Body>
    void for_alive(Body&& body)
    {
        parallel_for(
            alive_.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t i = begin; i < end; ++i) body(alive_[i]);
            },
            threads_);
    }

    void round(std::size_t goal, const collapse_rules& rules)
    {
        make_keys(rules);
        const auto& chosen = set_.choose(surface_, alive_, key_, threads_);
        evaluate(chosen, rules);
        drop_clashes();
        limit(alive_.size() - goal);
        commit();
    }

    void make_keys(const collapse_rules& rules)
    {
        // The area stays about the same while vertices go, so the mean star grows accordingly.
        const double mean = whole_ / static_cast<double>(alive_.size());
        const auto salt = scramble(static_cast<std::uint32_t>(log_.rounds.size()));
        stubborn_.resize(key_.size());
        for_alive(
            [&](idx id)
            {
                const auto v = static_cast<std::size_t>(id);
                const auto valence = static_cast<std::size_t>(surface_.rings.ranges[v].size);
                const auto size = static_cast<float>(static_cast<double>(size_[v]) / mean);
                // A boundary vertex of one triangle stays: its triangle would go with it.
                const bool possible = !surface_.keep[v] && !stubborn_[v] && valence >= 3 && valence <= largest_star &&
                                      static_cast<double>(size) <= rules.largest_size;
                key_[v] = possible ? make_key(id, valence, size, salt) : removal_key::never;
            });
    }

    /// Flattens the stars of the chosen vertices and finds the targets of their collapses.
    void evaluate(std::span<const idx> chosen, const collapse_rules& rules)
    {
        round_.collapses.resize(chosen.size());
        round_.first_corner.resize(chosen.size() + 1);
        idx corners = 0;
        for (std::size_t i = 0; i < chosen.size(); ++i)
        {
            const auto v = static_cast<std::size_t>(chosen[i]);
            round_.of[v] = static_cast<idx>(i);
            round_.first_corner[i] = corners;
            corners += surface_.rings.ranges[v].size;
        }
        round_.first_corner.back() = corners;
        round_.corners.resize(static_cast<std::size_t>(corners));
        parallel_for(
            chosen.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t i = begin; i < end; ++i)
                {
                    const idx v = chosen[i];
                    const bool open = surface_.open[static_cast<std::size_t>(v)] != 0;
                    const flat_star star = flatten(surface_.points, v, surface_.rings[v], open);
                    round_.collapses[i] = {v, choose_target(surface_, v, star, rules)};
                    std::copy_n(star.corner.begin(), star.size, round_.corners.begin() + round_.first_corner[i]);
                }
            },
            threads_, 128);
    }

    /// Drops clashing collapses: of two that make the same edge, the one with the larger key; and those without a
    /// target.
    void drop_clashes()
    {
        given_up_.assign(round_.collapses.size(), 0);
        parallel_for(
            given_up_.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t i = begin; i < end; ++i)
                {
                    const auto& c = round_.collapses[i];
                    if (c.target < 0) stubborn_[static_cast<std::size_t>(c.vertex)] = 1;
                    given_up_[i] = c.target < 0 || loses(surface_, round_, c, key_);
                }
            },
            threads_, 128);
        for (std::size_t i = 0; i < given_up_.size(); ++i)
            if (given_up_[i]) give_up(i);
    }

    void give_up(std::size_t i)
    {
        round_.of[static_cast<std::size_t>(round_.collapses[i].vertex)] = -1;
        round_.collapses[i].target = -1;
    }

    /// Keeps at most `most` collapses, those with the smallest keys.
    void limit(std::size_t most);

    void commit()
    {
        write_log();
        parallel_for(
            where_.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t i = begin; i < end; ++i) follow(surface_, round_, where_[i]);
            },
            threads_);
        std::erase_if(alive_, [&](idx v) { return round_.of[static_cast<std::size_t>(v)] >= 0; });
        splice_rings();
    }

    void write_log();

    /// Rewrites all rings. Their order in memory is nondeterministic; nothing depends on it.
    void splice_rings()
    {
        spare_.ranges.resize(surface_.rings.ranges.size());
        spare_.items.resize(surface_.rings.items.size()); // a collapse removes neighbours, on balance
        std::atomic<std::size_t> filled{0};
        parallel_for(
            alive_.size(),
            [&](std::size_t begin, std::size_t end)
            {
                std::vector<idx> rings;
                idx* out = nullptr;
                for (std::size_t i = begin; i < end; ++i)
                {
                    const auto v = static_cast<std::size_t>(alive_[i]);
                    const auto ring = surface_.rings[alive_[i]];
                    const auto first = static_cast<std::size_t>(out - rings.data());
                    if (first + largest_star * ring.size() > rings.size())
                    {
                        rings.resize(first + largest_star * ring.size() + 8 * (end - i));
                        out = rings.data() + first;
                    }
                    idx* const start = out;
                    out = splice(surface_, round_, alive_[i], out);
                    if (!std::equal(ring.begin(), ring.end(), start, out))
                    {
                        stubborn_[v] = 0;
                        size_[v] = star_size(surface_, alive_[i], {start, out});
                    }
                    spare_.ranges[v] = {static_cast<idx>(first), static_cast<idx>(out - start)};
                }
                rings.resize(static_cast<std::size_t>(out - rings.data()));
                const std::size_t place = filled.fetch_add(rings.size());
                std::copy(rings.begin(), rings.end(), spare_.items.begin() + static_cast<std::ptrdiff_t>(place));
                for (std::size_t i = begin; i < end; ++i)
                    spare_.ranges[static_cast<std::size_t>(alive_[i])].first += static_cast<idx>(place);
            },
            threads_);
        std::swap(surface_.rings, spare_);
    }

    thinning_surface surface_;
    unsigned threads_;
    std::vector<idx> alive_;           // ascending
    std::vector<surface_point> where_; // of each vertex at the start
    std::vector<std::uint32_t> key_;
    std::vector<float> size_;    // area of each star
    std::vector<char> stubborn_; // no target was found and the star is still the same
    double whole_ = 0;           // sum of the sizes at the start
    independent_set set_;
    collapse_round round_;
    std::vector<char> given_up_;
    ring_table spare_;
    removals<triangle> log_;
};

} // namespace taut::impl
