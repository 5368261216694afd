// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/cutting/laid_cells.hpp>
#include <taut/impl/charts/atlas/flatten_charts.hpp>
#include <taut/parameterize.hpp>

namespace taut::impl
{

/// Maps these charts, one flag each, anew with borders kept apart. Clears the flags where that succeeds.
/// roughly: in 100 steps, and not the large ones, each step of which costs what few cuts save
inline void keep_apart(atlas_run& run, chart_set& set, std::vector<char>& bad, bool roughly = false)
{
    constexpr idx most = 32;          // one by one: more would take long
    constexpr idx rough_most = 20000; // triangles
    const auto& charts = set.charts;
    const double begin = run.clock.total();
    idx mended = 0, tried = 0;
    for (std::size_t k = 0; k < bad.size(); ++k)
    {
        if (!bad[k] || !run.report.complete || tried == most) continue;
        if (roughly && charts.first_cell[k + 1] - charts.first_cell[k] > rough_most) continue;
        ++tried;
        const idx first = charts.first_vertex[k], end = charts.first_vertex[k + 1];
        parameterize_params params{.initial = {set.uv.begin() + first, set.uv.begin() + end},
                                   .placement = placement::as_solved,
                                   .holes = true,
                                   .no_overlap = true,
                                   .tuning = {.apart = overlaps_itself(charts, k, set.uv)}};
        if (roughly)
        {
            params.solve = rough_solve(100);
            params.precision = rough_precision(run.device);
        }
        const mesh<triangle> chart = chart_alone(charts, k);
        if (!check(chart, {.one_boundary = false}).empty()) continue;
        const auto map = parameterize(run.device, chart, params, run.limits("flatten"));
        if (!map) continue;
        std::copy(map.uv.begin(), map.uv.end(), set.uv.begin() + first);
        set.energy[k] = map.report.solve.value;
        bad[k] = 0;
        ++mended;
    }
    if (mended > 0)
    {
        const auto crossing = crossing_charts(charts, set.uv);
        for (std::size_t k = 0; k < bad.size(); ++k) bad[k] = bad[k] != 0 || crossing[k] != 0;
        auto note = std::to_string(mended) +
                    (mended == 1 ? " chart that overlapped itself was mapped anew with its border kept apart"
                                 : " charts that overlapped themselves were mapped anew with borders kept apart");
        auto& notes = run.report.notes;
        if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(std::move(note));
    }
    run.report.seconds.flatten += run.clock.total() - begin;
}

/// Parts these charts, one flag each, where they lie on themselves. Returns the flags of those that are unfit then.
inline std::vector<char> part_overlaps(const atlas_surface& of, chart_set& set, std::vector<char> bad)
{
    std::vector<idx> some;
    for (std::size_t k = 0; k < bad.size(); ++k)
        if (bad[k] && set.energy[k] < std::numeric_limits<double>::infinity())
            some.insert(some.end(), set.charts.cell_origins.begin() + set.charts.first_cell[k],
                        set.charts.cell_origins.begin() + set.charts.first_cell[k + 1]);
    if (some.empty()) return bad;
    std::sort(some.begin(), some.end());
    auto flat = laid(set);
    if (!part_laid(of.surface, {flat.seam, flat.uv, some},
                   {.price = of.prices(), .seams = of.params.charts.seams, .bound = of.params.charts.max_distortion}))
        return bad;
    set = cut(of, std::move(flat));
    measure(set);
    return unfit(set);
}

/// Divides these charts, one flag each, unless they are to be kept: into planar-projection patches of so many triangles
/// at most, or, where that is 0, into cells.
inline void take_apart(atlas_run& run, const atlas_surface& of, chart_set& set, const std::vector<char>& bad,
                       std::size_t largest)
{
    atlas_report& report = run.report;
    if (!report.reason.empty()) return;
    if (of.params.keeps_charts())
    {
        const auto first = std::find(bad.begin(), bad.end(), char(1)) - bad.begin();
        report.reason = report.name_chart(of.first_triangle(set.charts, static_cast<std::size_t>(first))) +
                        " has no map, or none without overlaps, and cannot be kept; let charts be made";
        return;
    }
    const auto wanted = by_triangle(set.charts, bad);
    auto flat = laid(set);
    const auto made =
        largest > 0
            ? take_patches(of, flat, lay_as_seen(of.surface, of.facets, wanted, of.params.charts.seams, largest))
            : lay_at_once(run, of, flat, wanted);
    set = cut(of, std::move(flat));
    const auto count = std::count(bad.begin(), bad.end(), char(1));
    report.notes.push_back(std::to_string(count) + (count == 1 ? " chart" : " charts") + " without a map became " +
                           std::to_string(made) + (largest > 0 ? ", laid as they are seen" : ", mapped at once"));
}

/// Removes the crossings of the borders of these charts, one flag each, and divides those for which that fails.
inline void mend(atlas_run& run, const atlas_surface& of, chart_set& set, std::vector<char> bad)
{
    keep_apart(run, set, bad);
    if (!of.params.keeps_charts() && run.report.complete) bad = part_overlaps(of, set, std::move(bad));
    if (std::count(bad.begin(), bad.end(), char(1)) > 0) take_apart(run, of, set, bad, 0);
}

/// Charts of a run that has ended; those without a good map are divided into cells. crosses: one flag per triangle, 1
/// where its chart overlaps itself
inline chart_set cut_unfinished(atlas_run& run, const atlas_surface& of, laid_surface laid,
                                std::span<const char> crosses)
{
    const double bound = of.params.charts.max_distortion;
    const double most = std::max(cell_growing::kept, std::isfinite(bound) ? bound : 4.0);
    std::vector<char> wanted(laid.energy.size());
    for (std::size_t c = 0; c < wanted.size(); ++c) wanted[c] = crosses[c] != 0 || !(laid.energy[c] <= most);
    if (std::count(wanted.begin(), wanted.end(), char(1)) > 0)
        run.report.notes.push_back("parts without a map by then became " +
                                   std::to_string(lay_at_once(run, of, laid, wanted)) + " charts, mapped at once");
    return cut(of, std::move(laid));
}

} // namespace taut::impl
