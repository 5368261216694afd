// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/cutting/mend_charts.hpp>
#include <taut/impl/charts/atlas/filled_square.hpp>
#include <taut/impl/charts/atlas/make_charts.hpp>
#include <taut/impl/charts/atlas/pressed_charts.hpp>
#include <taut/impl/charts/atlas/settled_charts.hpp>
#include <taut/impl/charts/atlas/stacked_charts.hpp>
#include <taut/impl/core/exact/convex_polygons.hpp>
#include <taut/impl/core/untangle/convex_corners.hpp>

namespace taut::impl
{

/// Places of charts in the tiles.
struct placed_charts
{
    std::vector<vec2> uv; ///< one per vertex of the charts, in the tiles
    packing layout;
    convex_polygons polygons;             ///< of the charts
    std::vector<char> bad;                ///< one per chart: whether it is not valid as it is laid
    std::vector<char> pinned;             ///< one per chart: whether it stays where it was; or empty
    std::optional<stacked_charts> stacks; ///< refers to the charts
    chart_outlines outlines; ///< of the charts as they were laid; the same in the tiles, unless triangles turned over
};

/// Values of the triangles of a surface, or none, for charts within each of which they are alike.
template <class T>
std::vector<T> by_chart(const chart_mesh& charts, const std::vector<T>& triangles)
{
    std::vector<T> values;
    if (!triangles.empty())
        for (std::size_t k = 0; k + 1 < charts.first_cell.size(); ++k)
            values.push_back(triangles[static_cast<std::size_t>(charts.first_triangle(k))]);
    return values;
}

/// The polygon of each triangle of the charts; empty: all are triangles.
inline std::vector<idx> polygon_labels(const atlas_surface& of, const chart_mesh& charts)
{
    if (of.params.charts.together.empty()) return {};
    const auto polygon = polygons_of(of.facets, of.params.charts.together);
    std::vector<idx> label;
    for (const idx c : charts.cell_origins) label.push_back(polygon[static_cast<std::size_t>(c)]);
    return label;
}

/// The polygons of charts that are convex in space.
inline convex_polygons convex(const atlas_surface& of, const chart_mesh& charts)
{
    return find_convex_polygons(charts.surface.cells(), polygon_labels(of, charts), charts.surface.points());
}

/// Makes polygons that are convex in space convex in the plane; at first with free borders, and with fixed ones in
/// charts that overlap themselves then. Charts that are to stay are moved as little as possible.
inline void make_convex(const atlas_run& run, const atlas_surface& of, chart_set& set, const convex_polygons& polygons)
{
    const chart_mesh& charts = set.charts;
    if (of.params.prefer == chart_preference::laid)
    {
        settle_charts(charts, polygons, set.uv, {});
        return;
    }
    const auto label = polygon_labels(of, charts);
    const auto before = set.uv;
    fixed_marks<2> held(set.uv.size());
    for (int round = 0; round < 2; ++round)
    {
        if (!convex_corners(charts.surface, label, polygons, held,
                            [&run] { return run.report.complete && run.clock.in_time(); })
                 .make_convex(set.uv))
            return;
        for (idx k = 0; k < charts.charts(); ++k)
        {
            const auto own = static_cast<std::size_t>(k);
            const auto first = charts.first_vertex[own], end = charts.first_vertex[own + 1];
            if (std::equal(set.uv.begin() + first, set.uv.begin() + end, before.begin() + first) ||
                !overlaps_itself(charts, own, set.uv))
                continue;
            std::copy(before.begin() + first, before.begin() + end, set.uv.begin() + first);
            for_each_border_side(charts, k,
                                 [&](idx from, idx) { held[static_cast<std::size_t>(from)] = fixed_marks<2>::every; });
        }
    }
}

/// Bends charts, and cuts them where the square is used much better then for the length of the cuts
/// (pressed_charts.hpp, filled_square.hpp).
inline void fill_square(atlas_run& run, const atlas_surface& of, chart_set& set)
{
    constexpr double least_length = 0.1, by_seams = 0.08; // that may be cut in all, by the root of the area
    constexpr idx few = 16;                               // charts
    if (!fills_squares(of.params)) return;
    if (!run.report.reason.empty() || !run.report.complete || set.charts.charts() > few) return;
    double area = 0;
    for (const double a : ideal_elements<triangle>(of.surface).measure) area += a;
    const double longest = least_length * std::sqrt(area) + by_seams * length_of_seams(of.surface, of.facets, set.seam);
    const pack_params packing = packing_of_square(of.params);
    const run_limits left = run.limits("pack");
    const auto prices = of.prices();
    laid_surface flat; // with the seams of cuts
    const auto find_cuts = [&]
    {
        flat = laid(set);
        filled_square filling(of.surface, of.facets, flat.uv, prices, packing, {left.time_limit, {}});
        flat.seam = filling.run(set.seam, longest, [&left] { return left.observer({}); });
        return filling.use();
    };
    const auto press = [&]
    { return chart_press(run, set, packing, bound_of_search(of)).run(of.params.charts.max_distortion); };
    const double use = find_cuts();
    bool cuts = flat.seam != set.seam;
    // Charts that are bent gain less by cuts: where these alone are enough, they come first.
    const bool enough = cuts && use >= filled_square::enough;
    if (!enough && press() && cuts)
    {
        find_cuts();
        cuts = flat.seam != set.seam;
    }
    if (cuts)
    {
        set = cut(of, std::move(flat));
        measure(set);
        if (!enough) press();
    }
    run.report.seconds.pack += run.clock.lap();
}

/// How much of a square as large as all tiles charts use, about, at whatever scale; 0: they do not fit.
inline double use_of_square(atlas_run& run, const atlas_surface& of, const chart_set& set)
{
    const pack_params& asked = of.params.packing;
    const double side = std::max(asked.resolution, asked.max_resolution) * std::sqrt(asked.tiles);
    const pack_params packing{
        .resolution = static_cast<int>(std::min(side, 65536.0)), .padding = asked.padding, .rotate = asked.rotate};
    const auto outlines =
        find_outlines(set.uv, set.charts.surface.cells(), set.charts.first_cell, set.charts.first_vertex);
    try
    {
        return pack_outlined(set.uv, outlines, packing, {run.limits("pack").time_limit, {}}, packing_effort::estimate)
            .utilization;
    }
    catch (const packing_error&)
    {
        return 0;
    }
}

/// Replaces charts that are to fill squares and do not by few along short seams, of the same bounds, if these do more.
inline void fill_more(atlas_run& run, const atlas_surface& of, chart_set& set)
{
    constexpr double gain = 0.03; // of the use: estimates differ by as much
    constexpr idx small = 50'000; // triangles: short seams of more take long
    atlas_report& report = run.report;
    const auto& asked = of.params;
    if (asked.prefer != chart_preference::packing || asked.stack || of.surface.cell_count() > small ||
        !report.reason.empty() || !report.complete)
        return;
    const double use = use_of_square(run, of, set);
    if (!(use < filled_square::enough)) return;
    atlas_params params = asked;
    params.prefer = chart_preference::seams;
    atlas_surface other{of.surface, params, of.origins, of.facets};
    auto notes = std::exchange(report.notes, {});
    chart_set few = make_charts(run, other);
    fill_square(run, other, few);
    const bool holds = mean_energy(few) <= std::max(asked.charts.mean_distortion, mean_energy(set));
    const bool more = report.reason.empty() && report.complete && holds && use_of_square(run, other, few) > use + gain;
    report.reason.clear();
    report.reason_triangles.clear();
    if (more)
        set = std::move(few);
    else
        report.notes = std::move(notes);
}

/// Turns charts by less than 45 degrees so that their tightest boxes are parallel to the page, for a packer that only
/// translates them: nobody has seen them yet.
inline void set_upright(const atlas_surface& of, chart_set& set)
{
    if (of.params.packing.rotate || of.params.keeps_charts()) return;
    for (std::size_t k = 0; k + 1 < set.charts.first_vertex.size(); ++k)
    {
        const auto own = std::span(set.uv).subspan(
            static_cast<std::size_t>(set.charts.first_vertex[k]),
            static_cast<std::size_t>(set.charts.first_vertex[k + 1] - set.charts.first_vertex[k]));
        const auto hull = convex_hull({own.begin(), own.end()});
        if (hull.size() < 3) continue;
        vec2 axis = tightest_axis(hull);
        if (std::abs(axis.y) > std::abs(axis.x)) axis = {axis.y, -axis.x};
        if (axis.x < 0) axis = -axis;
        constexpr double parallel = 1e-12;
        if (!(std::abs(axis.y) > parallel)) continue;
        for (vec2& p : own) p = {axis.x * p.x + axis.y * p.y, axis.x * p.y - axis.y * p.x};
    }
}

/// By how much a chart is to be scaled up, as its triangles are not much larger than the units of the file's numbers;
/// 1: they are.
inline double growth(const placed_charts& placed, const chart_mesh& charts, std::size_t k, vec2 (*stored)(vec2))
{
    const auto first = placed.uv.data();
    const auto [low, high] = box_about({first + charts.first_vertex[k], first + charts.first_vertex[k + 1]});
    const double wanted = 256 * std::sqrt(static_cast<double>(charts.first_cell[k + 1] - charts.first_cell[k])) *
                          spacing_at(high, stored);
    const double size = glm::length(high - low);
    return size >= wanted ? 1 : std::min(1e9, 2 * wanted / std::max(size, wanted * 1e-9));
}

/// Throws packing_error where a given density leaves no chart that is larger than the digits of the file.
inline void require_digits(const atlas_surface& of, const chart_set& set, const placed_charts& placed)
{
    const double density = of.params.packing.texels_per_unit;
    if (!(density > 0) || placed.layout.places.empty()) return; // there is a reason for none
    for (std::size_t k = 0; k < static_cast<std::size_t>(set.charts.charts()); ++k)
        if (growth(placed, set.charts, k, of.params.stored) == 1) return;
    throw packing_error(packing_error::no_room, {},
                        "at " + short_number(density) +
                            " texels a unit all charts are too small for the digits of the file; ask for more texels "
                            "a unit");
}

/// Where a layout has the vertices of its charts, with tiles in rows of ten from origin on.
inline std::vector<vec2> in_rows_of_tiles(const packing& layout, std::span<const idx> first_vertex,
                                          std::span<const vec2> uv, vec2 origin, double aspect)
{
    auto placed = layout.apply(uv, first_vertex);
    for (std::size_t k = 0; k < layout.places.size(); ++k)
    {
        const idx row = layout.places[k].tile / 10;
        for (idx v = first_vertex[k]; v < first_vertex[k + 1]; ++v)
            placed[static_cast<std::size_t>(v)] += vec2(origin.x - 10 * row, (origin.y + row) * aspect);
    }
    return placed;
}

/// A label per chart, which those that may lie on each other have in common: they are of one tile and one density.
inline std::vector<idx> stack_labels(const std::vector<idx>& groups, const std::vector<double>& densities)
{
    if (densities.empty()) return groups;
    std::map<std::pair<idx, double>, idx> numbers;
    std::vector<idx> labels;
    for (std::size_t k = 0; k < densities.size(); ++k)
        labels.push_back(
            numbers.emplace(std::pair(groups.empty() ? 0 : groups[k], densities[k]), static_cast<idx>(numbers.size()))
                .first->second);
    return labels;
}

/// Packs charts into the tiles, rounded as in the file.
/// grown: how much larger the chart of each triangle of the surface is laid; empty if none is
inline placed_charts place(atlas_run& run, const atlas_surface& of, chart_set& set, const std::vector<double>& grown)
{
    placed_charts made;
    atlas_report& report = run.report;
    if (!report.reason.empty())
    {
        made.uv = set.uv;
        return made;
    }
    const chart_mesh& charts = set.charts;
    made.polygons = convex(of, charts); // there is room for it: nothing is beside a chart yet
    if (made.polygons.size() > 0) make_convex(run, of, set, made.polygons);
    auto params = of.params.packing;
    params.groups = by_chart(charts, params.groups);
    params.densities = by_chart(charts, params.densities);
    const auto labels = stack_labels(params.groups, params.densities);
    const auto factors = by_chart(charts, grown);
    if (params.densities.empty())
        params.densities = factors;
    else
        for (std::size_t k = 0; k < factors.size(); ++k) params.densities[k] *= factors[k];
    auto& stacks = made.stacks;
    if (of.params.stack)
    {
        stacks.emplace(charts, by_charts(charts, of.params.charts.together), labels);
        stacks->take_best(set.uv, set.energy);
        stacks->leave_unlike(set.uv, of.params.charts.max_distortion);
        stacks->share(set.uv);
        report.stacked = charts.charts() - static_cast<idx>(stacks->leaders().size());
    }
    const vec2 origin = of.params.origin;
    const idx rows = (params.tiles + 9) / 10;
    const double step = spacing_at(
        origin + vec2(std::min(params.tiles, 10), rows * std::max(params.aspect, 1.0)) - 0.25, of.params.stored);
    params.rounding = std::max(params.rounding, 4 * step); // so far vertices may be moved
    made.outlines = find_outlines(set.uv, charts.surface.cells(), charts.first_cell, charts.first_vertex);
    if (stacks)
    {
        params.densities = stacks->of_leaders(params.densities);
        params.groups = stacks->of_leaders(params.groups);
    }
    made.layout = pack_outlined(set.uv, stacks ? stacks->first_outlines(made.outlines) : made.outlines, params,
                                run.limits("pack"));
    if (stacks) made.layout.places = stacks->of_all(made.layout.places);
    report.complete = report.complete && made.layout.complete;
    made.uv = in_rows_of_tiles(made.layout, charts.first_vertex, set.uv, origin, params.aspect);
    if (grown.empty()) require_digits(of, set, made); // before the work on numbers that have none
    made.bad = settle_charts(charts, made.polygons, made.uv, {.stored = of.params.stored, .reach = params.rounding});
    if (stacks)
    {
        stacks->share(made.uv);
        made.bad = stacks->bad_of_all(made.bad, made.uv);
    }
    report.seconds.pack += run.clock.lap();
    return made;
}

/// Maps charts, one flag each, anew of which rounding makes the border meet itself, but flattens no triangle: those of
/// plain shapes touch themselves. Clears their flags.
inline void keep_touching_apart(atlas_run& run, chart_set& set, const placed_charts& placed, std::vector<char>& bad)
{
    std::vector<char> touching(bad.size());
    for (std::size_t k = 0; k < bad.size(); ++k) touching[k] = bad[k] && turned_triangle(set.charts, k, placed.uv) < 0;
    const auto before = touching;
    keep_apart(run, set, touching);
    for (std::size_t k = 0; k < bad.size(); ++k)
        if (before[k]) bad[k] = touching[k];
}

/// Packs charts, and replaces those that rounding makes invalid and that cannot be corrected in place: by larger ones,
/// if they are small for the digits of the file, else by smaller patches.
inline placed_charts settled(atlas_run& run, const atlas_surface& of, chart_set& set)
{
    constexpr int most_rounds = 32; // places change for all charts, and so do the digits of those that were good
    std::vector<double> grown;
    set_upright(of, set);
    placed_charts placed = place(run, of, set, grown);
    for (int round = 0; round < most_rounds; ++round)
    {
        if (!run.report.reason.empty() || std::count(placed.bad.begin(), placed.bad.end(), char(1)) == 0) break;
        auto bad = placed.bad;
        for (std::size_t k = 0; k < bad.size(); ++k)
        {
            const double factor = bad[k] ? growth(placed, set.charts, k, of.params.stored) : 1;
            if (factor == 1) continue;
            bad[k] = 0;
            grown.resize(of.surface.cells().size(), 1.0);
            for (idx i = set.charts.first_cell[k]; i < set.charts.first_cell[k + 1]; ++i)
                grown[static_cast<std::size_t>(set.charts.cell_origins[static_cast<std::size_t>(i)])] *= factor;
        }
        if (round == 0 && !of.params.keeps_charts() && run.report.complete) keep_touching_apart(run, set, placed, bad);
        idx largest = 0; // of those that are left
        for (std::size_t k = 0; k < bad.size(); ++k)
            if (bad[k]) largest = std::max(largest, set.charts.first_cell[k + 1] - set.charts.first_cell[k]);
        if (largest > 0)
        {
            take_apart(run, of, set, bad, std::clamp<std::size_t>(static_cast<std::size_t>(largest) / 4, 1, 1024));
            join_polygons(run, of, set);
            set_upright(of, set);
        }
        if (run.report.reason.empty()) placed = place(run, of, set, grown);
    }
    const auto densities = by_chart(set.charts, grown);
    const auto count = std::count_if(densities.begin(), densities.end(), [](double x) { return x > 1; });
    if (count > 0)
        run.report.notes.push_back(std::to_string(count) + (count == 1 ? " chart is" : " charts are") +
                                   " scaled up, as the numbers of the file are too coarse for " +
                                   (count == 1 ? "it" : "them"));
    return placed;
}

} // namespace taut::impl
