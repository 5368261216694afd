// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <taut/impl/charts/atlas/atlas_run.hpp>
#include <taut/impl/charts/atlas/chart_set.hpp>
#include <taut/impl/charts/atlas/cutting/disk_cells.hpp>
#include <taut/impl/charts/atlas/cutting/part_charts.hpp>
#include <taut/impl/charts/atlas/seen_patches.hpp>

namespace taut::impl
{

/// Computes the energies of the charts of these triangles, ascending ones of whole charts; infinite where one overlaps
/// itself.
inline void measure(const mesh<triangle>& m, std::span<const idx> some, laid_surface& laid)
{
    const surface_part part = part_of(m, some, laid.seam);
    const auto uv = part.by_vertex(laid.uv);
    const auto crossing = crossing_charts(part.charts, uv);
    const ideal_elements<triangle> ideal(part.charts.surface);
    for (std::size_t k = 0; k < crossing.size(); ++k)
        part.write(k,
                   crossing[k] ? std::numeric_limits<double>::infinity()
                               : area_and_energy(part.charts, k, uv, ideal).second,
                   uv, laid);
}

/// Replaces the maps of some triangles, with seams around them. label(triangle): its new chart, -1 if unchanged;
/// energy_of(label), uv_of(triangle, corner): of the new ones
template <class Label, class Energy, class Map>
void lay_anew(const atlas_surface& of, laid_surface& laid, Label&& label, Energy&& energy_of, Map&& uv_of)
{
    const auto& twin = of.facets.twin;
    parallel_for(laid.energy.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t c = begin; c < end; ++c)
                     {
                         const idx own = label(c);
                         if (own >= 0) laid.energy[c] = energy_of(own);
                         for (std::size_t s = 3 * c; s < 3 * c + 3; ++s)
                         {
                             if (own >= 0) laid.uv[s] = uv_of(c, s % 3);
                             if (twin[s] < 0) continue;
                             const idx other = label(static_cast<std::size_t>(twin[s]) / 3);
                             if (own >= 0 || other >= 0) laid.seam[s] = of.is_given(s) || own != other;
                         }
                     }
                 });
}

/// Takes steps with the maps of cells, in a run that has ended for a tenth of the time so far, and parts those that lie
/// on themselves then. longest: seconds; wanted: one flag per triangle
inline void relax_cells(const atlas_run& run, const atlas_surface& of, laid_surface& laid, std::span<const char> wanted,
                        double longest)
{
    constexpr double part = 0.1;         // complete atlases are the same on any machine
    constexpr std::size_t many = 50'000; // triangles, too many to part in that time
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    const surface_part own = part_of(of.surface, wanted, laid.seam);
    const auto start = own.by_vertex(laid.uv);
    flatten_params params;
    params.initial = start;
    params.max_iterations = std::min(params.max_iterations, 25);
    params.tolerance = std::max(params.tolerance, 1e-3);
    run_limits limits;
    if (!run.report.complete) limits.time_limit = budget::seconds(std::min(longest, part * run.clock.total()));
    const auto maps = flatten_charts(run.device, own.charts, params, limits);
    const auto crossing = crossing_charts(own.charts, maps.uv);
    std::vector<idx> some, chart(wanted.size(), -1); // triangles of charts that lie on themselves; their charts
    for (std::size_t k = 0; k < maps.charts.size(); ++k)
    {
        const auto first = u(own.charts.first_cell[k]), end = u(own.charts.first_cell[k + 1]);
        if (!maps.charts[k].valid || !(maps.charts[k].energy < laid.energy[u(own.triangles[first])])) continue;
        if (!crossing[k])
            own.write(k, maps.charts[k].energy, maps.uv, laid);
        else
            for (auto i = first; i < end; ++i) chart[u(some.emplace_back(own.triangles[i]))] = static_cast<idx>(k);
    }
    if (some.empty() || some.size() > many) return;
    std::sort(some.begin(), some.end());
    auto parted = laid;
    for (std::size_t k = 0; k < maps.charts.size(); ++k)
        if (crossing[k] && maps.charts[k].valid) own.write(k, maps.charts[k].energy, maps.uv, parted);
    // Charts are taken or refused by themselves below, so none gets anything of another.
    part_laid(of.surface, {parted.seam, parted.uv, some},
              {.price = of.prices(), .seams = of.params.charts.seams, .give = false});
    measure(of.surface, some, parted);
    std::vector<char> refused(maps.charts.size(), 0);
    for (const idx c : some)
        if (!(parted.energy[u(c)] < std::numeric_limits<double>::infinity())) refused[u(chart[u(c)])] = 1;
    for (const idx c : some)
    {
        if (refused[u(chart[u(c)])]) continue;
        laid.energy[u(c)] = parted.energy[u(c)];
        for (std::size_t s = 3 * u(c); s < 3 * u(c) + 3; ++s)
        {
            laid.uv[s] = parted.uv[s];
            laid.seam[s] = parted.seam[s];
        }
    }
}

/// Divides these triangles, one flag each, into cells, and maps these at once. Returns the number of cells.
inline std::size_t lay_cells(const atlas_run& run, const atlas_surface& of, laid_surface& laid,
                             std::span<const char> wanted)
{
    struct division
    {
        std::ptrdiff_t size, count; // triangles of a cell, cells, about
        double worst, longest;      // energy, seconds
    };
    // Cells that are divided again take as long once more.
    constexpr division usual{2048, 128, 6, 0.5}, at_once{512, 1024, std::numeric_limits<double>::infinity(), 0.1};
    constexpr std::ptrdiff_t many = 100'000; // triangles, whose maps take long
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    const auto all = std::count(wanted.begin(), wanted.end(), char(1));
    const division& how = run.report.complete || all <= many ? usual : at_once;
    const auto made = cell_growing(of.surface, of.facets, of.params.charts.seams, of.params.charts.together)
                          .run(wanted, static_cast<idx>(std::max(how.size, all / how.count)), how.worst);
    std::vector<std::array<idx, 2>> place(wanted.size(), {-1, 0}); // cell, place in it
    for (std::size_t k = 0; k < made.size(); ++k)
        for (std::size_t i = 0; i < made[k].triangles.size(); ++i)
            place[u(made[k].triangles[i])] = {static_cast<idx>(k), static_cast<idx>(i)};
    lay_anew(
        of, laid, [&](std::size_t c) { return place[c][0]; }, [&](idx cell) { return made[u(cell)].energy; },
        [&](std::size_t c, std::size_t k) { return made[u(place[c][0])].uv[u(place[c][1])][k]; });
    relax_cells(run, of, laid, wanted, how.longest);
    return made.size();
}

/// Takes patches as charts. Returns their number.
inline std::size_t take_patches(const atlas_surface& of, laid_surface& laid, const seen_patches& seen)
{
    lay_anew(
        of, laid, [&](std::size_t c) { return seen.patch[c]; },
        [&](idx patch) { return seen.energy[static_cast<std::size_t>(patch)]; },
        [&](std::size_t c, std::size_t k) { return seen.uv[c][k]; });
    return seen.energy.size();
}

/// Divides these triangles, one flag each, into planar-projection patches, or into cells where the surface is too
/// rough for that. Returns the number of charts.
inline std::size_t lay_at_once(const atlas_run& run, const atlas_surface& of, laid_surface& laid,
                               std::span<const char> wanted)
{
    constexpr std::size_t fewest = 10;    // triangles of a patch in the mean; cells are fewer, but more distorted
    constexpr std::size_t many = 50'000;  // triangles, worth more threads
    constexpr std::size_t most = 200'000; // triangles, whose cells take seconds: only where patches would fill no page
    constexpr std::size_t crumbs = 3;     // triangles of a patch in the mean, then
    constexpr std::size_t largest = 1024; // triangles of a patch
    const auto all = static_cast<std::size_t>(std::count(wanted.begin(), wanted.end(), char(1)));
    std::vector<char> parts(wanted.begin(), wanted.end());
    if (!run.report.complete && all > many)
    {
        const auto octant = octants(of.surface);
        for (std::size_t c = 0; c < parts.size(); ++c)
            if (parts[c] != 0) parts[c] = octant[c];
    }
    const auto seen = lay_as_seen(of.surface, of.facets, parts, of.params.charts.seams, largest);
    const std::size_t least = all > most ? crumbs : fewest;
    return all >= least * seen.energy.size() ? take_patches(of, laid, seen) : lay_cells(run, of, laid, wanted);
}

} // namespace taut::impl
