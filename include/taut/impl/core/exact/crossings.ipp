// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <tuple>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/exact/crossings.hpp>
#include <taut/types.hpp>

namespace taut
{

std::size_t boundary_crossings(std::span<const std::vector<idx>> loops, std::span<const vec2> x)
{
    std::size_t count = 0;
    impl::for_each_meeting(impl::edges_of(loops), x,
                           [&count](std::size_t, std::size_t)
                           {
                               ++count;
                               return true;
                           });
    return count;
}

} // namespace taut

namespace taut::impl
{

bool segments_meet(const vec2& a, const vec2& b, const vec2& c, const vec2& d)
{
    const int abc = orient2d(a, b, c);
    const int abd = orient2d(a, b, d);
    const int cda = orient2d(c, d, a);
    const int cdb = orient2d(c, d, b);
    if (abc * abd < 0 && cda * cdb < 0) return true;
    return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) || (cda == 0 && between(c, d, a)) ||
           (cdb == 0 && between(c, d, b));
}

bool edges_meet(const std::array<idx, 2>& e, const std::array<idx, 2>& f, std::span<const vec2> x)
{
    const auto at = [&x](idx v) { return x[static_cast<std::size_t>(v)]; };
    const auto [a, b] = e;
    const auto [c, d] = f;
    if ((a == c && b == d) || (a == d && b == c)) return true;
    if (b == c) return folds_back(at(a), at(b), at(d));
    if (a == d) return folds_back(at(b), at(a), at(c));
    if (a == c) return folds_back(at(b), at(a), at(d));
    if (b == d) return folds_back(at(a), at(b), at(c));
    return segments_meet(at(a), at(b), at(c), at(d));
}

edge_tree::edge_tree(std::span<const std::array<idx, 2>> edges, std::span<const vec2> x, std::span<const idx> groups)
    : entries_(edges.size())
{
    if (edges.empty()) return;
    parallel_for(edges.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t e = begin; e < end; ++e)
                         entries_[e] = {edge_box::of(edges[e], x), static_cast<idx>(e)};
                 });
    const auto size = static_cast<idx>(edges.size()), count = static_cast<idx>(groups.size()) - 1;
    nodes_.resize(u(size + std::max<idx>(0, count - 1)));
    if (groups.empty())
    {
        build_all(entries_, leaf, {{0, 0, size, none}});
        return;
    }
    // A tree has fewer nodes than what it holds, or one, so those of a group are numbered as its edges are.
    std::vector<part> whole;
    for (idx g = 0; g < count; ++g) whole.push_back({groups[u(g)], groups[u(g)], groups[u(g) + 1], g});
    build_all(entries_, leaf, std::move(whole));
    std::vector<entry> roots;
    for (idx g = 0; g < count; ++g) roots.push_back({nodes_[u(groups[u(g)])].bounds, groups[u(g)]});
    if (count > 1) build_all(roots, 1, {{root_ = size, 0, count, none}});
}

std::pair<edge_tree::part, edge_tree::part> edge_tree::halve(std::span<entry> entries, idx least, const part& p)
{
    node& whole = enclose(entries, p);
    const vec2 extent = whole.bounds.high / 2.0 - whole.bounds.low / 2.0;
    const int side = extent.x >= extent.y ? 0 : 1;
    const idx half = (p.last - p.first) / 2, middle = p.first + half;
    std::nth_element(entries.begin() + p.first, entries.begin() + middle, entries.begin() + p.last,
                     [side](const entry& a, const entry& b)
                     {
                         const double x = a.centre(side), y = b.centre(side);
                         return x != y ? x < y : a.number < b.number;
                     });
    const auto root_of = [&](const part& q)
    { return least == 1 && q.last - q.first == 1 ? entries[u(q.first)].number : q.node; };
    const part left{p.node + 1, p.first, middle, p.group}, right{p.node + half, middle, p.last, p.group};
    whole.left = root_of(left);
    whole.right = root_of(right);
    return {left, right};
}

void edge_tree::build_all(std::span<entry> entries, idx least, std::vector<part> parts)
{
    constexpr idx large = 8192; // entries that are worth another thread
    std::vector<part> small;
    while (!parts.empty())
    {
        const auto end =
            std::partition(parts.begin(), parts.end(), [](const part& p) { return p.last - p.first > large; });
        small.insert(small.end(), end, parts.end());
        parts.erase(end, parts.end());
        std::vector<part> halves(2 * parts.size());
        parallel_for(
            parts.size(),
            [&](std::size_t begin, std::size_t last)
            {
                for (std::size_t k = begin; k < last; ++k)
                    std::tie(halves[2 * k], halves[2 * k + 1]) = halve(entries, least, parts[k]);
            },
            0, 1);
        parts = std::move(halves);
    }
    parallel_for(
        small.size(),
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t k = begin; k < end; ++k) build(entries, least, small[k]);
        },
        0, 1);
}

void edge_tree::build(std::span<entry> entries, idx least, const part& p)
{
    if (p.last - p.first > least)
    {
        const auto [left, right] = halve(entries, least, p);
        build(entries, least, left);
        build(entries, least, right);
    }
    else if (least > 1)
        enclose(entries, p);
}

std::vector<std::array<idx, 2>> edges_of(std::span<const std::vector<idx>> loops)
{
    std::vector<std::array<idx, 2>> edges;
    for (const auto& loop : loops)
        for (std::size_t k = 0; k < loop.size(); ++k) edges.push_back({loop[k], loop[(k + 1) % loop.size()]});
    return edges;
}

} // namespace taut::impl
