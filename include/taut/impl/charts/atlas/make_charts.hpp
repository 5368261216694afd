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

#include <taut/impl/charts/atlas/chart_start.hpp>
#include <taut/impl/charts/atlas/page_cuts.hpp>
#include <taut/impl/charts/atlas/short_charts.hpp>
#include <taut/impl/charts/atlas/stacked_charts.hpp>
#include <taut/impl/charts/atlas/symmetry.hpp>
#include <taut/impl/charts/atlas/symmetry/symmetric_half.hpp>
#include <taut/impl/core/core/short_number.hpp>

namespace taut::impl
{

/// Charts that segment() cuts.
inline chart_set segmented_charts(atlas_run& run, const atlas_surface& of)
{
    run.usable = true; // whatever there is by the end of the time is laid as it is seen
    auto params = of.params.charts;
    params.weights = of.factors;
    // What takes more steps at first is mostly cut after all of them.
    constexpr int few = 25;
    const auto first_maps = [&run](const chart_mesh& charts, std::span<const vec2> start)
    {
        return run.flatten(charts, start, atlas_run::precise::usual,
                           start.empty() ? few : std::numeric_limits<int>::max());
    };
    auto made = segment_surface(of.surface, of.facets, maps_by(first_maps), params, run.limits("charts"));
    if (!run.goes_on()) return cut_unfinished(run, of, std::move(made.laid), made.crosses);
    chart_set set = cut(of, std::move(made.laid));
    mend(run, of, set, unfit(set));
    return set;
}

/// Flags of the sides of a surface, or none, for the sides of its charts.
inline std::vector<char> by_charts(const chart_mesh& charts, std::span<const char> sides)
{
    std::vector<char> own;
    if (!sides.empty())
        for (const idx c : charts.cell_origins)
            for (std::size_t k = 0; k < 3; ++k) own.push_back(sides[3 * static_cast<std::size_t>(c) + k]);
    return own;
}

/// Maps of polygons, for those that are cut along other diagonals.
class polygon_maps
{
public:
    /// Refers to all. f: facets of m; together: its diagonals, or empty
    polygon_maps(const mesh<triangle>& m, const facet_table& f, std::span<const char> together)
        : mesh_(m), polygon_(polygons_of(f, together)), corners_(m.cells().size())
    {
    }

    /// A corner of the polygon of this side, where the side begins, is that of another one.
    void take(std::size_t side, std::size_t from) { corners_[polygon(side)].push_back({start(side), from}); }

    /// The corner of which this one is a copy, or itself.
    std::size_t origin(std::size_t corner) const
    {
        const idx v = mesh_.cells()[corner / 3][corner % 3];
        for (const auto& [vertex, from] : corners_[polygon(corner)])
            if (vertex == v) return 3 * (from / 3) + (from + 1) % 3;
        return corner;
    }

private:
    std::size_t polygon(std::size_t side) const { return static_cast<std::size_t>(polygon_[side / 3]); }
    idx start(std::size_t side) const { return mesh_.cells()[side / 3][(side + 1) % 3]; }

    const mesh<triangle>& mesh_;
    std::vector<idx> polygon_;                                      // one per triangle
    std::vector<std::vector<std::pair<idx, std::size_t>>> corners_; // of polygons: vertices, and the sides of others
};

/// Leaves components as they were, whose charts are distorted beyond the bound as copies: other diagonals of polygons,
/// another distortion. whole: components; flat: the copies, not measured
inline void leave_distorted(const atlas_surface& of, const chart_mesh& whole, const laid_surface& before,
                            laid_surface& flat)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    chart_set made = cut(of, flat);
    measure(made);
    const auto after = by_triangle(made.charts, made.energy);
    const double most = of.params.charts.max_distortion;
    for (std::size_t k = 0; k < u(whole.charts()); ++k)
    {
        const auto first = whole.cell_origins.begin() + whole.first_cell[k],
                   last = whole.cell_origins.begin() + whole.first_cell[k + 1];
        if (std::none_of(first, last, [&](idx c) { return after[u(c)] > std::max(most, before.energy[u(c)]); }))
            continue;
        for (auto c = first; c != last; ++c)
        {
            flat.energy[u(*c)] = before.energy[u(*c)];
            for (std::size_t s = 3 * u(*c); s < 3 * u(*c) + 3; ++s)
            {
                flat.seam[s] = before.seam[s];
                flat.uv[s] = before.uv[s];
            }
        }
    }
}

/// Cuts components that are copies of each other in space as the least distorted of them is cut, with its maps.
inline void copy_components(atlas_run& run, const atlas_surface& of, chart_set& set)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    const auto& together = of.params.charts.together;
    const chart_mesh whole = cut_charts(of.surface, of.facets, std::vector<char>(set.seam.size(), 0));
    const stacked_charts copies(whole, by_charts(whole, together), {});
    if (copies.leaders().size() == copies.leader().size()) return;
    const auto own = [&](idx side) { return 3 * u(whole.cell_origins[u(side / 3)]) + u(side % 3); };
    const auto before = laid(set);
    std::vector<double> energy; // of each component, by area
    for (idx k = 0; k < whole.charts(); ++k)
    {
        energy.push_back(0);
        for (auto c = u(whole.first_cell[u(k)]); c < u(whole.first_cell[u(k) + 1]); ++c)
            energy.back() +=
                before.energy[u(whole.cell_origins[c])] * triangle_area(whole.surface, static_cast<idx>(c));
    }
    const auto best = copies.best(energy, false);
    const auto is_outer = [&](idx side) { return together.empty() || !together[own(side)]; };
    std::vector<idx> model(set.seam.size()); // of each side of a first copy, that of the best one
    for (idx k = 0; k < whole.charts(); ++k)
        if (best[u(copies.leader()[u(k)])] == k)
            for (idx s = 3 * whole.first_cell[u(k)]; s < 3 * whole.first_cell[u(k) + 1]; ++s)
                if (is_outer(s)) model[u(copies.sides()[u(s)])] = s;
    auto flat = before;
    polygon_maps maps(of.surface, of.facets, together);
    const auto copy = [&](idx k)
    {
        if (best[u(copies.leader()[u(k)])] == k) return;
        const idx begin = 3 * whole.first_cell[u(k)], end = 3 * whole.first_cell[u(k) + 1];
        for (idx s = begin; s < end; ++s)
            if (is_outer(s)) maps.take(own(s), own(model[u(copies.sides()[u(s)])]));
        const auto at = [&](idx s) { return before.uv[maps.origin(own(s))]; };
        bool turned = false; // on other diagonals
        for (idx s = begin; s < end && !together.empty(); s += 3)
            turned = turned || orient2d(at(s), at(s + 1), at(s + 2)) <= 0;
        if (turned) return;
        for (idx s = begin; s < end; ++s)
        {
            const idx from = is_outer(s) ? model[u(copies.sides()[u(s)])] : -1;
            flat.seam[own(s)] = (from >= 0 && before.seam[own(from)] != 0) || of.is_given(own(s));
            flat.uv[own(s)] = at(s); // a side and a corner have one number
            flat.energy[own(s) / 3] = before.energy[maps.origin(own(s)) / 3];
        }
    };
    for (idx k = 0; k < whole.charts(); ++k) copy(k);
    if (!together.empty()) leave_distorted(of, whole, before, flat);
    const double bound = std::max(of.params.charts.mean_distortion, mean_energy(set));
    set = cut(of, std::move(flat));
    if (together.empty()) return;
    measure(set);
    if (const double mean = mean_energy(set); mean > bound)
        run.report.notes.push_back(
            "the mean energy is " + short_number(mean) +
            ", above the bound, as polygons of copies are cut along other diagonals; triangulate "
            "the file, or give a tighter bound");
}

/// Makes polygons that are divided by seams charts of their own.
inline void join_polygons(atlas_run& run, const atlas_surface& of, chart_set& set)
{
    const auto& together = of.params.charts.together;
    if (together.empty() || !run.report.reason.empty()) return;
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    const auto polygon = polygons_of(of.facets, together);
    std::vector<char> parted(polygon.size(), 0), wanted(polygon.size());
    for (std::size_t s = 0; s < together.size(); ++s)
        if (together[s] != 0 && of.facets.twin[s] >= 0 && set.seam[s] != 0) parted[u(polygon[s / 3])] = 1;
    if (std::count(parted.begin(), parted.end(), char(1)) == 0) return;
    for (std::size_t c = 0; c < wanted.size(); ++c) wanted[c] = parted[u(polygon[c])];
    auto flat = laid(set);
    lay_anew(
        of, flat, [&](std::size_t c) { return wanted[c] ? polygon[c] : -1; },
        [](idx) { return std::numeric_limits<double>::infinity(); },
        [](std::size_t, std::size_t) { return vec2(0.0); });
    const surface_part part = part_of(of.surface, wanted, flat.seam);
    flatten_params few;
    few.max_iterations = run.report.complete ? few.max_iterations : 0; // their starts are made at once
    auto maps = flatten_charts(run.device, part.charts, few);
    const ideal_elements<triangle> ideal(part.charts.surface);
    for (std::size_t k = 0; k < maps.charts.size(); ++k)
    {
        double& energy = maps.charts[k].energy;
        if (!(energy < std::numeric_limits<double>::infinity()) || overlaps_itself(part.charts, k, maps.uv))
        {
            lay_round(part.charts, k, maps.uv);
            energy = area_and_energy(part.charts, k, maps.uv, ideal).second;
        }
        part.write(k, energy, maps.uv, flat);
    }
    set = cut(of, std::move(flat));
    run.report.notes.push_back("polygons that were in several charts became charts by themselves");
    mend(run, of, set, unfit(set));
}

/// Cuts charts that are larger than a tile at the density that is asked for, but polygons.
inline void fit_tiles(atlas_run& run, const atlas_surface& of, chart_set& set)
{
    constexpr int most_rounds = 8; // polygons that are cut become charts, which cut others further
    if (!(of.params.packing.texels_per_unit > 0) || !run.report.reason.empty()) return;
    idx cuts = 0;
    for (int round = 0, before = -1; round < most_rounds && cuts != before; ++round)
    {
        before = cuts;
        cuts += page_cuts(of, set).run();
        if (cuts != before) join_polygons(run, of, set);
    }
    if (cuts > 0)
        run.report.notes.push_back("charts larger than a tile at " + short_number(of.params.packing.texels_per_unit) +
                                   " texels a unit were cut so that they fit, " + std::to_string(cuts) +
                                   (cuts == 1 ? " time" : " times"));
}

/// Charts that are cut as the preference says.
inline chart_set free_charts(atlas_run& run, const atlas_surface& of)
{
    chart_set set = of.params.prefer == chart_preference::packing ? segmented_charts(run, of) : short_charts(run, of);
    join_polygons(run, of, set);
    fit_tiles(run, of, set);
    if (of.params.stack && run.report.reason.empty()) copy_components(run, of, set);
    return set;
}

/// Charts of one half of a symmetric surface, and their mirror images.
inline chart_set symmetric_charts(atlas_run& run, atlas_surface& of)
{
    of.mirror = find_symmetry(of.surface, of.facets, of.params.charts.together);
    const symmetric_half half(of.surface, of.facets, *of.mirror);
    std::vector<char> seams, together;
    const atlas_params of_half = half.params(of.params, seams, together);
    atlas_surface own{half.surface(), of_half};
    own.weigh_seams();
    const laid_surface made = laid(free_charts(run, own));
    laid_surface whole{half.seams(made.seam), std::vector<vec2>(of.facets.twin.size()),
                       std::vector<double>(of.surface.cells().size())};
    half.for_each_corner(
        [&](std::size_t corner, std::size_t from, bool mirrored)
        {
            whole.uv[corner] = mirrored ? vec2(-made.uv[from].x, made.uv[from].y) : made.uv[from];
            whole.energy[corner / 3] = made.energy[from / 3];
        });
    chart_set set = cut(of, std::move(whole));
    // Where polygons that are mirror images are cut along other diagonals, triangles may be flipped.
    std::vector<char> turned(set.energy.size());
    for (std::size_t k = 0; k < turned.size(); ++k) turned[k] = turned_triangle(set.charts, k, set.uv) >= 0;
    mend(run, of, set, std::move(turned));
    join_polygons(run, of, set);
    return set;
}

/// Takes the maps of kept charts as they are, each with the area that its triangles have on the surface.
inline void lay_as_given(atlas_run& run, const atlas_surface& of, chart_set& set)
{
    const ideal_elements<triangle> ideal(set.charts.surface);
    const auto& cells = set.charts.surface.cells();
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    for (std::size_t k = 0; k < u(set.charts.charts()); ++k)
    {
        double in_plane = 0, in_space = 0;
        for (auto c = u(set.charts.first_cell[k]); c < u(set.charts.first_cell[k + 1]); ++c)
        {
            in_plane += orient(set.uv[u(cells[c][0])], set.uv[u(cells[c][1])], set.uv[u(cells[c][2])]).det / 2;
            in_space += ideal.measure[c];
        }
        const double scale = in_plane != 0 ? std::sqrt(in_space / std::abs(in_plane)) : 1;
        for (auto v = u(set.charts.first_vertex[k]); v < u(set.charts.first_vertex[k + 1]); ++v)
            set.uv[v] *= vec2(in_plane < 0 ? -scale : scale, scale);
    }
    measure(set);
    run.usable = true;
    const auto bad = unfit(set);
    if (const auto first = std::find(bad.begin(), bad.end(), char(1)); first != bad.end())
        run.report.reason =
            run.report.name_chart(of.first_triangle(set.charts, static_cast<std::size_t>(first - bad.begin()))) +
            " is folded, or overlaps itself, as it is given; relax it (--charts keep), or let charts be made";
}

/// Charts that are given by their seams.
inline chart_set kept_charts(atlas_run& run, const atlas_surface& of)
{
    std::vector<char> seam(of.params.charts.seams.begin(), of.params.charts.seams.end());
    seam.resize(of.facets.twin.size(), 0);
    chart_mesh charts = cut_charts(of.surface, of.facets, seam);
    std::vector<vec2> initial(of.params.initial.empty() ? 0 : charts.surface.points().size());
    if (!initial.empty())
        for_each_corner(charts, [&](std::size_t cell, std::size_t corner, std::size_t v)
                        { initial[v] = of.params.initial[cell][corner]; });
    chart_set set{std::move(seam), std::move(charts), std::move(initial), {}};
    set.energy.resize(static_cast<std::size_t>(set.charts.charts()));
    if (of.params.prefer == chart_preference::laid && !set.uv.empty())
    {
        lay_as_given(run, of, set);
        return set;
    }
    flatten(run, set);
    mend(run, of, set, unfit(set));
    return set;
}

/// Charts of a surface as they are asked for, each with its map.
inline chart_set make_charts(atlas_run& run, atlas_surface& of)
{
    of.weigh_seams();
    chart_set set = of.params.keeps_charts() ? kept_charts(run, of)
                    : of.params.symmetric    ? symmetric_charts(run, of)
                                             : free_charts(run, of);
    run.report.seconds.charts = run.clock.lap() - run.report.seconds.flatten;
    return set;
}

} // namespace taut::impl
