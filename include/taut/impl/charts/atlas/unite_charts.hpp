// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <taut/impl/charts/atlas/chart_moments.hpp>
#include <taut/impl/charts/atlas/seams/seam_arcs.hpp>
#include <taut/impl/charts/atlas/surface_charts.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Candidates for unions of charts.
enum class unions
{
    all,   ///< pairs of neighbours
    small, ///< such pairs of little area: cuts leave many behind, and they cost little
    slits  ///< charts that cross themselves, without a slit that may be why
};

/// Two neighbouring charts, or one with a slit given twice, and the arc between them.
struct union_candidate
{
    double price = 0; ///< estimated excess of their union
    idx arc = 0;
    std::array<idx, 2> charts;
};

/// Unions that may be within the bounds, those first that cost least. room: excess that is allowed
inline std::vector<union_candidate> union_candidates(const surface_charts& all, const csr& arcs, double room,
                                                     unions what)
{
    constexpr double little = 0.01; // of all area
    const bool slits = what == unions::slits;
    const auto u = surface_charts::u;
    std::vector<chart_moments> moments(all.records.size());
    for (idx c = 0; c < all.surface.cell_count(); ++c)
    {
        const auto x = all.surface.rest(c);
        moments[u(all.chart[u(c)])] += chart_moments::of_triangle(glm::cross(x[1] - x[0], x[2] - x[0]));
        for (std::size_t s = 3 * u(c); s < 3 * u(c) + 3; ++s)
            if (all.facets.twin[s] < 0 || all.laid.seam[s]) moments[u(all.chart[u(c)])].perimeter += all.length(s);
    }
    std::vector<union_candidate> pairs;
    for (idx a = 0; a < arcs.rows(); ++a)
    {
        const idx side = arcs.row(a)[0];
        const idx p = all.chart[u(side) / 3], q = all.chart[u(all.facets.twin[u(side)]) / 3];
        if ((p == q) != slits || (slits && !all.records[u(p)].shape.crosses)) continue;
        if (!(all.records[u(p)].energy < surface_charts::infinite) ||
            !(all.records[u(q)].energy < surface_charts::infinite))
            continue;
        double shared = 0;
        bool kept = false;
        for (const idx s : arcs.row(a))
        {
            shared += all.length(u(s));
            kept = kept || (!all.params.seams.empty() && all.params.seams[u(s)]);
        }
        const std::array<idx, 2> both{std::min(p, q), std::max(p, q)};
        if (kept || std::binary_search(all.refused.begin(), all.refused.end(), both)) continue;
        chart_moments sum = moments[u(p)];
        if (p != q) sum += moments[u(q)];
        sum.perimeter -= 2 * shared;
        if (what == unions::small && sum.area > little * all.total_area) continue;
        const double strain = sum.strain();
        // An estimate that is far above the bound is seldom wrong.
        if (strain / sum.area > 4 * (all.params.max_distortion - 4)) continue;
        const double more = strain / 2 - all.before(both).excess();
        if (more < 2 * room) pairs.push_back({more, a, both});
    }
    std::stable_sort(pairs.begin(), pairs.end(), [](const auto& x, const auto& y) { return x.price < y.price; });
    return pairs;
}

/// Returns whether a chart is a disk, or one with holes: by Euler, V - E + F = 2 - loops.
inline std::vector<char> planar(const chart_mesh& charts)
{
    const auto u = surface_charts::u;
    std::vector<idx> twice(u(charts.charts()), 0), loops(twice.size(), 0); // twice V - E + F
    std::size_t k = 0;
    for (const auto& loop : boundary_loops(charts.surface))
    {
        while (loop[0] >= charts.first_vertex[k + 1]) ++k;
        ++loops[k];
        twice[k] -= static_cast<idx>(loop.size());
    }
    std::vector<char> result(twice.size());
    for (k = 0; k < twice.size(); ++k)
    {
        twice[k] += 2 * (charts.first_vertex[k + 1] - charts.first_vertex[k]) -
                    (charts.first_cell[k + 1] - charts.first_cell[k]);
        result[k] = loops[k] > 0 && twice[k] == 2 * (2 - loops[k]);
    }
    return result;
}

/// Pairs of charts as one chart each.
struct united_pairs
{
    surface_part part;
    std::vector<std::size_t> pairs; ///< one per chart: its place among those that were tried
};

/// Unites pairs of charts where that makes disks, or such with holes, and refuses others: a slit around a handle, or
/// the only one of a closed surface, must stay. No value: none is left.
inline std::optional<united_pairs> united(surface_charts& all, const csr& arcs, std::span<const union_candidate> tried)
{
    const auto u = surface_charts::u;
    auto seam = all.laid.seam;
    std::vector<idx> involved;
    std::vector<std::size_t> pair_of(all.records.size(), 0);
    const auto involve = [&](const std::array<idx, 2>& charts)
    { involved.insert(involved.end(), charts.begin(), charts.end() - (charts[0] == charts[1])); };
    for (std::size_t i = 0; i < tried.size(); ++i)
    {
        for (const idx s : arcs.row(tried[i].arc)) seam[u(s)] = seam[u(all.facets.twin[u(s)])] = 0;
        for (const idx k : tried[i].charts) pair_of[u(k)] = i;
        involve(tried[i].charts);
    }
    const auto unite = [&]
    {
        united_pairs made{part_of(all.surface, all.triangles_of(involved), seam), {}};
        for (idx k = 0; k < made.part.charts.charts(); ++k)
            made.pairs.push_back(pair_of[u(all.chart[u(made.part.first_triangle(u(k)))])]);
        return made;
    };
    united_pairs made = unite();
    const auto open = planar(made.part.charts);
    if (std::count(open.begin(), open.end(), 0) == 0) return made;
    involved.clear();
    for (std::size_t k = 0; k < open.size(); ++k)
        if (open[k])
            involve(tried[made.pairs[k]].charts);
        else
            all.refused.push_back(tried[made.pairs[k]].charts);
    std::sort(all.refused.begin(), all.refused.end());
    if (involved.empty()) return {};
    return unite();
}

/// Replaces two charts by their union, which is chart k of a part.
inline void accept(surface_charts& all, std::span<const idx> arc, const std::array<idx, 2>& charts,
                   const surface_part& part, const chart_maps& maps, const laid_shape& shape, idx k)
{
    const auto u = surface_charts::u;
    ++all.report.united;
    for (const idx s : arc) all.laid.seam[u(s)] = all.laid.seam[u(all.facets.twin[u(s)])] = 0;
    for (const idx old : charts) all.records[u(old)].triangles.clear();
    all.take(part, maps, shape, k);
}

/// Flattens unions, and keeps those within the bounds. Returns whether one was kept.
inline bool try_unions(surface_charts& all, const csr& arcs, std::span<const union_candidate> tried, double room,
                       unions what)
{
    const auto u = surface_charts::u;
    const auto made = united(all, arcs, tried);
    if (!made) return false;
    const auto& [part, pairs] = *made;
    const auto [maps, shapes] = all.flatten(part);
    if (all.clock.over()) return false;
    struct trial
    {
        double more = 0;
        std::size_t pair = 0;
        idx chart = 0; // of the part
    };
    // Slim charts do not pack well, and small ones are what fills the gaps.
    const double slimmest = what == unions::small ? 0.85 : 0.72;
    std::vector<trial> trials;
    for (idx k = 0; k < part.charts.charts(); ++k)
    {
        const std::size_t i = pairs[u(k)];
        const chart_record was = all.before(tried[i].charts);
        const double more = (maps.energy[u(k)] - 4) * was.area - was.excess();
        const laid_shape& shape = shapes[u(k)];
        const bool slit = tried[i].charts[0] == tried[i].charts[1]; // there may be others
        const bool lies_well = !shape.crosses && shape.fill >= std::min(slimmest, was.shape.fill);
        const bool good = maps.energy[u(k)] <= all.params.max_distortion && (slit || lies_well);
        trials.push_back({good ? more : surface_charts::infinite, i, k});
    }
    std::stable_sort(trials.begin(), trials.end(), [](const trial& x, const trial& y) { return x.more < y.more; });
    const idx before = all.report.united;
    for (const trial& t : trials)
    {
        const auto& pair = tried[t.pair];
        if (!(t.more <= room))
        {
            all.refused.push_back(pair.charts);
            continue;
        }
        room -= t.more;
        accept(all, arcs.row(pair.arc), pair.charts, part, maps, shapes[u(t.chart)], t.chart);
    }
    std::sort(all.refused.begin(), all.refused.end());
    return all.report.united > before;
}

/// Flattens pairs of neighbouring charts as one, and keeps those within the bounds. Returns false if no pair is
/// left.
inline bool unite_round(surface_charts& all, unions what)
{
    const auto u = surface_charts::u;
    const bool slits = what == unions::slits;
    const double room = all.allowed() - all.total_excess();
    if (!(room > 0)) return false;
    const auto crossing = [](const chart_record& r) { return !r.triangles.empty() && r.shape.crosses; };
    if (slits && std::none_of(all.records.begin(), all.records.end(), crossing)) return false;
    if (all.sides.items.empty()) all.sides = starting_sides(all.surface);
    const csr arcs = seam_arcs(all.surface, all.facets, all.sides, all.laid.seam);
    const auto pairs = union_candidates(all, arcs, room, what);
    std::vector<char> taken(all.records.size(), 0);
    std::vector<union_candidate> tried;
    double planned = 0;
    for (const union_candidate& p : pairs)
    {
        if (taken[u(p.charts[0])] || taken[u(p.charts[1])] || planned > 2 * room) continue;
        taken[u(p.charts[0])] = taken[u(p.charts[1])] = 1;
        planned += std::max(0.0, p.price);
        tried.push_back(p);
    }
    return !tried.empty() && try_unions(all, arcs, tried, room, what);
}

/// Unites pairs in rounds; one that unites less than a fifteenth of more than a thousand charts is the last.
inline void unite_all(surface_charts& all)
{
    for (idx round = 0; round < all.params.tuning.unite_rounds && all.proceed(round); ++round)
    {
        const auto left =
            std::count_if(all.records.begin(), all.records.end(), [](auto& r) { return !r.triangles.empty(); });
        const std::ptrdiff_t before = all.report.united;
        if (!unite_round(all, unions::all) || (left > 1000 && 15 * (all.report.united - before) < left)) return;
    }
}

} // namespace taut::impl
