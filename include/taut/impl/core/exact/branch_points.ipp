// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <span>

#include <taut/certify.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/exact/branch_points.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/core/exact/simplex_role.hpp>

namespace taut::impl
{

std::size_t vertex_link::loops()
{
    std::sort(edges_.begin(), edges_.end());
    std::vector<char> seen(edges_.size(), 0);
    std::size_t count = 0;
    for (std::size_t first = 0; first < edges_.size(); ++first)
    {
        if (seen[first]) continue;
        ++count;
        std::size_t e = first;
        do {
            if (seen[e]) return 0;
            seen[e] = 1;
            e = after(e);
            if (e == edges_.size()) return 0;
        } while (e != first);
    }
    return count;
}

} // namespace taut::impl

namespace taut
{

std::vector<idx> branch_points(std::span<const std::array<idx, 3>> cells, std::span<const vec2> x,
                               std::span<const idx> owners)
{
    const auto roles = impl::simplex_roles<2>(owners);
    const auto corners_of = [&](std::size_t t)
    { return roles.empty() || roles[t] == impl::simplex_role::cell ? std::size_t{3} : std::size_t{1}; };
    const auto at = [&](idx v) -> const vec2& { return x[static_cast<std::size_t>(v)]; };
    const auto rises = [&](idx v, idx a, idx b) { return at(a).y < at(v).y && at(b).y >= at(v).y; };
    std::vector<std::uint16_t> turns(x.size(), 0); // two and more are told apart from fewer, no further
    std::atomic<bool> suspicious{false};
    impl::parallel_for(cells.size(),
                       [&](std::size_t begin, std::size_t end)
                       {
                           for (std::size_t c = begin; c < end; ++c)
                               for (std::size_t k = 0; k < corners_of(c); ++k)
                               {
                                   const auto& t = cells[c];
                                   if (!rises(t[k], t[(k + 1) % 3], t[(k + 2) % 3])) continue;
                                   const std::atomic_ref n(turns[static_cast<std::size_t>(t[k])]);
                                   if (n.load(std::memory_order_relaxed) < 2 && n.fetch_add(1) == 1) suspicious = true;
                               }
                       });
    if (!suspicious) return {};

    struct neighbourhood
    {
        idx vertex;
        std::size_t turns = 0;
        bool positive = false, negative = false;
        impl::vertex_link link;

        bool oriented() const { return positive != negative; }
    };
    std::vector<neighbourhood> around;
    std::vector<idx> place(x.size(), -1);
    for (std::size_t v = 0; v < x.size(); ++v)
        if (turns[v] >= 2)
        {
            place[v] = static_cast<idx>(around.size());
            around.push_back({.vertex = static_cast<idx>(v), .link = {}});
        }
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (std::size_t k = 0; k < corners_of(c); ++k)
        {
            const auto& t = cells[c];
            const idx i = place[static_cast<std::size_t>(t[k])], a = t[(k + 1) % 3], b = t[(k + 2) % 3];
            if (i < 0) continue;
            auto& n = around[static_cast<std::size_t>(i)];
            n.link.add(a, b);
            n.turns += rises(t[k], a, b);
            const int sign = impl::orient(at(t[k]), at(a), at(b)).sign;
            n.positive = n.positive || sign >= 0;
            n.negative = n.negative || sign <= 0;
        }
    std::vector<idx> found;
    for (auto& n : around)
        if (const std::size_t loops = n.oriented() ? n.link.loops() : 0; loops > 0 && n.turns > loops)
            found.push_back(n.vertex);
    return found;
}

} // namespace taut
