// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <taut/impl/atlas/cutting/disk_cells.hpp>
#include <taut/impl/atlas/cutting/part_charts.hpp>
#include <taut/impl/atlas/cutting/way_prices.hpp>
#include <taut/impl/atlas/flat_charts.hpp>
#include <taut/impl/atlas/seen_patches.hpp>

namespace taut::impl
{

/// Energy of the chart of each of these triangles, ascending ones of whole charts; infinite where it overlaps itself.
/// seam, uv: one per side and corner of the surface
inline std::vector<double> parted_energies(const mesh<triangle>& m, std::span<const idx> some,
                                           std::span<const char> seam, std::span<const vec2> uv)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    std::vector<idx> number(m.points().size(), -1), place(m.cells().size(), -1);
    for (std::size_t i = 0; i < some.size(); ++i) place[u(some[i])] = static_cast<idx>(i);
    const surface_part part = part_of(m, some, seam, number);
    std::vector<vec2> own(part.charts.surface.points().size());
    for (std::size_t i = 0; i < part.triangles.size(); ++i)
        for (std::size_t j = 0; j < 3; ++j)
            own[u(part.charts.surface.cells()[i][j])] = uv[3 * u(part.triangles[i]) + j];
    const auto crossing = crossing_charts(part.charts, own);
    const ideal_elements<triangle> ideal(part.charts.surface);
    std::vector<double> energies(some.size());
    for (std::size_t k = 0; k < crossing.size(); ++k)
    {
        const double energy =
            crossing[k] ? std::numeric_limits<double>::infinity() : area_and_energy(part.charts, k, own, ideal).second;
        for (auto i = u(part.charts.first_cell[k]); i < u(part.charts.first_cell[k + 1]); ++i)
            energies[u(place[u(part.triangles[i])])] = energy;
    }
    return energies;
}

inline std::size_t flat_charts::take_patches(laid_triangles& laid, const seen_patches& seen)
{
    lay_anew(
        laid, [&](std::size_t c) { return seen.patch[c]; }, [&](idx patch) { return seen.energy[u(patch)]; },
        [&](std::size_t c, std::size_t k) { return seen.uv[c][k]; });
    return seen.energy.size();
}

inline std::size_t flat_charts::lay_at_once(laid_triangles& laid, std::span<const char> wanted)
{
    constexpr std::size_t fewest = 10;    // triangles of a patch in the mean; cells are fewer, but more distorted
    constexpr std::size_t many = 50'000;  // triangles, worth more threads
    constexpr std::size_t most = 200'000; // triangles, whose cells take seconds: only where patches would fill no page
    constexpr std::size_t crumbs = 3;     // triangles of a patch in the mean, then
    constexpr std::size_t largest = 1024; // triangles of a patch
    const auto all = static_cast<std::size_t>(std::count(wanted.begin(), wanted.end(), char(1)));
    std::vector<char> parts(wanted.begin(), wanted.end());
    if (!report_.complete && all > many)
    {
        const auto octant = octants(mesh_);
        for (std::size_t c = 0; c < parts.size(); ++c)
            if (parts[c] != 0) parts[c] = octant[c];
    }
    const auto seen = lay_as_seen(mesh_, facets_, parts, params_.charts.seams, largest);
    const std::size_t least = all > most ? crumbs : fewest;
    return all >= least * seen.energy.size() ? take_patches(laid, seen) : lay_cells(laid, wanted);
}

inline std::size_t flat_charts::lay_cells(laid_triangles& laid, std::span<const char> wanted)
{
    constexpr std::ptrdiff_t size = 2048, count = 128; // triangles of a cell, cells, about
    const auto all = std::count(wanted.begin(), wanted.end(), char(1));
    const auto made = cell_growing(mesh_, facets_, params_.charts.seams, params_.charts.together)
                          .run(wanted, static_cast<idx>(std::max(size, all / count)));
    std::vector<std::array<idx, 2>> place(wanted.size(), {-1, 0}); // cell, place in it
    for (std::size_t k = 0; k < made.size(); ++k)
        for (std::size_t i = 0; i < made[k].triangles.size(); ++i)
            place[u(made[k].triangles[i])] = {static_cast<idx>(k), static_cast<idx>(i)};
    lay_anew(
        laid, [&](std::size_t c) { return place[c][0]; }, [&](idx cell) { return made[u(cell)].energy; },
        [&](std::size_t c, std::size_t k) { return made[u(place[c][0])].uv[u(place[c][1])][k]; });
    relax_cells(laid, wanted);
    return made.size();
}

inline void flat_charts::relax_cells(laid_triangles& laid, std::span<const char> wanted)
{
    constexpr double part = 0.1, longest = 0.5; // seconds; complete atlases are the same on any machine
    constexpr std::size_t many = 50'000;        // triangles, too many to part in that time
    std::vector<idx> triangles, number(mesh_.points().size(), -1);
    for (std::size_t c = 0; c < wanted.size(); ++c)
        if (wanted[c]) triangles.push_back(static_cast<idx>(c));
    const surface_part own = part_of(mesh_, triangles, seam_, number);
    const auto& cells = own.charts.surface.cells();
    std::vector<vec2> start(own.charts.surface.points().size());
    for (std::size_t i = 0; i < cells.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) start[u(cells[i][k])] = laid.uv[3 * u(own.triangles[i]) + k];
    flatten_params params;
    params.initial = start;
    params.max_iterations = std::min(params.max_iterations, 25);
    params.tolerance = std::max(params.tolerance, 1e-3);
    if (!report_.complete) params.limits.time_limit = budget::seconds(std::min(longest, part * budget_.total()));
    const auto maps = flatten_charts(queue_, own.charts, params);
    const auto crossing = crossing_charts(own.charts, maps.uv);
    const auto take = [&](std::size_t k, laid_triangles& to)
    {
        for (auto i = u(own.charts.first_cell[k]); i < u(own.charts.first_cell[k + 1]); ++i)
        {
            to.energy[u(own.triangles[i])] = maps.charts[k].energy;
            for (std::size_t j = 0; j < 3; ++j) to.uv[3 * u(own.triangles[i]) + j] = maps.uv[u(cells[i][j])];
        }
    };
    std::vector<idx> some, of(mesh_.cells().size(), -1); // triangles of charts that lie on themselves; their charts
    for (std::size_t k = 0; k < maps.charts.size(); ++k)
    {
        const auto first = u(own.charts.first_cell[k]), end = u(own.charts.first_cell[k + 1]);
        if (!maps.charts[k].valid || !(maps.charts[k].energy < laid.energy[u(own.triangles[first])])) continue;
        if (!crossing[k])
            take(k, laid);
        else
            for (auto i = first; i < end; ++i) of[u(some.emplace_back(own.triangles[i]))] = static_cast<idx>(k);
    }
    if (some.empty() || some.size() > many) return;
    std::sort(some.begin(), some.end());
    auto parted = laid;
    auto seam = seam_;
    for (std::size_t k = 0; k < maps.charts.size(); ++k)
        if (crossing[k] && maps.charts[k].valid) take(k, parted);
    part_laid(mesh_, {seam, parted.uv, some}, side_prices(mesh_, facets_, params_.charts.together, factors_));
    const auto then = parted_energies(mesh_, some, seam, parted.uv);
    std::vector<char> refused(maps.charts.size(), 0);
    for (std::size_t i = 0; i < some.size(); ++i)
        if (!(then[i] < std::numeric_limits<double>::infinity())) refused[u(of[u(some[i])])] = 1;
    for (std::size_t i = 0; i < some.size(); ++i)
    {
        const auto c = u(some[i]);
        if (refused[u(of[c])]) continue;
        laid.energy[c] = then[i];
        for (std::size_t s = 3 * c; s < 3 * c + 3; ++s)
        {
            laid.uv[s] = parted.uv[s];
            seam_[s] = seam[s];
        }
    }
}

} // namespace taut::impl
