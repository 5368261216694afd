// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/atlas.hpp>
#include <taut/impl/charts/atlas/make_atlas.hpp>
#include <taut/impl/charts/atlas/pinned_charts.hpp>
#include <taut/impl/charts/atlas/place_charts.hpp>
#include <taut/impl/charts/packing/certificate.hpp>
#include <taut/pack.hpp>

namespace taut::impl
{

/// Length of the seams, times how much is seen of their ends.
inline double seen_length(const atlas_surface& of, std::span<const char> seam)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    double sum = 0;
    for (std::size_t s = 0; s < seam.size(); ++s)
    {
        if (!seam[s] || of.facets.twin[s] < static_cast<idx>(s)) continue;
        const auto [a, b] = side_vertices(of.surface, static_cast<idx>(s));
        sum +=
            glm::distance(of.surface.points()[u(a)], of.surface.points()[u(b)]) * 0.5 * (of.open[u(a)] + of.open[u(b)]);
    }
    return sum;
}

/// Measures the seams of a surface.
inline void measure_seams(atlas_report& report, const atlas_surface& of, std::span<const char> seam)
{
    report.seam_length = length_of_seams(of.surface, of.facets, seam);
    if (!of.open.empty() && report.seam_length > 0) report.seen_seam = seen_length(of, seam) / report.seam_length;
}

/// " (3, 8, ...)", the flipped triangles as the surface numbers them, which are noted.
inline std::string turned_ids(atlas_report& report, const chart_mesh& charts)
{
    std::string text;
    for (const idx c : report.flips.ids)
    {
        const idx origin = report.reason_triangles.emplace_back(charts.cell_origins[static_cast<std::size_t>(c)]);
        text += (text.empty() ? " (" : ", ") + std::to_string(origin);
    }
    return text.empty() ? text : text + (report.flips.flipped > report.flips.ids.size() ? ", ...)" : ")");
}

/// Says why an atlas is none, if so. crossing: one flag per chart
inline void find_reason(atlas_report& report, const pack_params& params, const chart_mesh& charts,
                        const placed_charts& placed, const packing_certificate& sealed,
                        const std::vector<char>& crossing)
{
    constexpr const char* remedy = "a file with more digits (.obj) may keep them, or --no-rotation";
    auto& named = report.reason_triangles;
    if (!report.flips)
    {
        const auto ids = turned_ids(report, charts);
        report.reason = std::to_string(report.flips.flipped) + " triangles" + ids +
                        " are flipped by the digits of the file; " + remedy;
    }
    else if (const auto bad = std::find(crossing.begin(), crossing.end(), char(1)); bad != crossing.end())
    {
        const auto k = static_cast<std::size_t>(bad - crossing.begin());
        named = {charts.first_triangle(k)};
        report.reason = "the border of chart " + std::to_string(k) + ", that of triangle " + std::to_string(named[0]) +
                        ", meets itself in the digits of the file; " + remedy;
    }
    else if (report.overlaps > 0)
    {
        for (const idx k : sealed.overlaps.first) // of each stack the first chart
        {
            const idx chart = placed.stacks ? placed.stacks->leaders()[static_cast<std::size_t>(k)] : k;
            named.push_back(charts.first_triangle(static_cast<std::size_t>(chart)));
        }
        report.reason = std::to_string(report.overlaps) +
                        " charts overlap in the atlas: the first are those of triangles " + std::to_string(named[0]) +
                        " and " + std::to_string(named[1]);
    }
    else if (!sealed.holds(params.padding, report.resolution))
        report.reason = "charts are nearer to each other, or to the border, than the padding";
}

/// Notes how many charts are thinner than a texel: their area by half the length of their border, the width of a strip.
inline void note_thin_charts(atlas_report& report, const chart_mesh& charts, const placed_charts& placed)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    const auto at = [&](idx v) { return placed.uv[u(v)]; };
    const chart_outlines& outlines = placed.outlines;
    std::size_t thin = 0;
    for (idx k = 0; k < charts.charts(); ++k)
    {
        double twice = 0, border = 0; // the area, the length
        for (idx c = charts.first_cell[u(k)]; c < charts.first_cell[u(k) + 1]; ++c)
        {
            const auto& [i, j, l] = charts.surface.cells()[u(c)];
            twice += std::abs(glm::determinant(mat2(at(j) - at(i), at(l) - at(i))));
        }
        for (idx e = outlines.first[u(k)]; e < outlines.first[u(k) + 1]; ++e)
            border += glm::distance(at(outlines.edges[u(e)][0]), at(outlines.edges[u(e)][1]));
        thin += twice * report.resolution < border;
    }
    if (thin > 0)
        report.notes.push_back(std::to_string(thin) + (thin == 1 ? " chart is" : " charts are") +
                               " thinner than a texel in the mean, with " + std::to_string(report.resolution) +
                               " along a tile; a higher resolution helps");
}

/// Certifies charts in their places, and fills the report with what they measure.
inline void certify_charts(atlas_run& run, const atlas_surface& of, const chart_mesh& charts, placed_charts& placed)
{
    atlas_report& report = run.report;
    const pack_params& params = of.params.packing;
    summarize(report, charts, placed.uv, placed.layout);
    report.tiles = placed.layout.tiles > 0 ? placed.layout.tiles : params.tiles;
    report.resolution = placed.layout.resolution > 0 ? placed.layout.resolution : params.resolution;
    if (!report.reason.empty()) return;
    const auto& cells = charts.surface.cells();
    report.flips = certify<2>(cells, std::span<const vec2>(placed.uv));
    if (!report.flips || placed.outlines.turned || placed.outlines.charts() != charts.charts())
        placed.outlines = find_outlines(placed.uv, cells, charts.first_cell, charts.first_vertex);
    // Copies are where the first ones are.
    const auto sealed = certify_outlined(
        placed.uv, cells, placed.stacks ? placed.stacks->first_outlines(placed.outlines) : placed.outlines,
        placed.pinned, params.aspect);
    report.polygons = static_cast<std::size_t>(placed.polygons.size());
    report.concave = find_concave(placed.polygons, placed.uv).size();
    const auto crossing = crossing_charts(charts, placed.uv);
    report.overlaps =
        sealed.overlaps.pairs + static_cast<std::size_t>(std::count(crossing.begin(), crossing.end(), char(1)));
    report.least_distance = std::min(sealed.gap, sealed.border) * report.resolution;
    report.seconds.certify += run.clock.lap();
    find_reason(report, params, charts, placed, sealed, crossing);
    note_thin_charts(report, charts, placed);
    if (report.concave > 0)
        report.notes.push_back(std::to_string(report.concave) +
                               (report.concave == 1 ? " polygon is" : " polygons are") +
                               " not convex in the atlas, though in space; cut along other diagonals, triangles of "
                               "them turn over");
}

/// Adds pinned charts to those of the rest of a surface, `whole`.
inline void join_pinned(atlas_report& report, const pinned_charts& pins, const atlas_surface& whole, chart_set& set,
                        placed_charts& placed)
{
    pins.join(set.charts, placed.uv, placed.layout, placed.pinned);
    placed.polygons = convex(whole, set.charts);
    const auto staying = std::count(placed.pinned.begin(), placed.pinned.end(), char(1));
    report.notes.push_back(std::to_string(staying) + (staying == 1 ? " chart stays" : " charts stay") + " where " +
                           (staying == 1 ? "it was" : "they were"));
    report.seam_length = length_of_seams(whole.surface, whole.facets, seams_of(set.charts, whole.facets));
}

inline bool pins_any(const atlas_params& params)
{
    return std::any_of(params.pinned.begin(), params.pinned.end(), [](char flag) { return flag != 0; });
}

/// Throws parameter_error where parameters contradict each other, or are of another surface.
inline void require(const mesh<triangle>& m, const atlas_params& params)
{
    if (params.symmetric && (params.keeps_charts() || !params.pinned.empty()))
        throw parameter_error("symmetric", "makes charts; none can be kept or pinned");
    if (params.symmetric && params.stack)
        throw parameter_error("stack", "is of copies, and mirror images are none; leave out `symmetric`");
    if (!params.charts.weights.empty() && (params.symmetric || !params.pinned.empty()))
        throw parameter_error("weights", "are of the whole surface; leave out `symmetric` and `pinned`");
    const auto& groups = params.packing.groups;
    const auto& densities = params.packing.densities;
    if (!groups.empty() && groups.size() != m.cells().size())
        throw parameter_error("groups", "empty or one tile a triangle");
    if (!densities.empty() && densities.size() != m.cells().size())
        throw parameter_error("densities", "empty or one number a triangle");
    if (params.stack && !params.pinned.empty())
        throw parameter_error("stack", "is of charts that are placed; pin none");
    if (!params.pinned.empty() && params.packing.aspect != 1)
        throw parameter_error("aspect", "pinned charts lie in squares; give 1, or pin none");
    if (pins_any(params)) pinned_charts::require(m, params);
}

/// make_atlas() of a surface whose areas, and products of them, do not overflow.
inline atlas atlas_in_range(queue& q, const mesh<triangle>& m, const atlas_params& params, const run_limits& limits)
{
    atlas_run run{q, limits};
    atlas_surface whole{m, params};
    validate(m, whole.facets, atlas_requirements);
    std::optional<pinned_charts> pins;
    std::optional<atlas_surface> rest; // without pinned charts
    std::vector<char> seams, together;
    atlas_params of_rest;
    if (pins_any(params))
    {
        pins.emplace(m, whole.facets, params);
        of_rest = pins->of_rest(seams, together);
        rest.emplace(atlas_surface{pins->rest().charts.surface, of_rest, pins->rest().triangles});
    }
    atlas_surface& of = rest ? *rest : whole;
    run.report.seconds.setup = run.clock.lap();
    chart_set set = make_charts(run, of);
    fill_square(run, of, set);
    fill_more(run, of, set);
    placed_charts placed = settled(run, of, set);
    measure_seams(run.report, of, set.seam);
    if (of.mirror)
    {
        const auto [pairs, own] = count_mirrored(set.charts, *of.mirror);
        run.report.symmetry = {of.mirror->normal, of.mirror->offset, pairs, own};
    }
    if (pins) join_pinned(run.report, *pins, whole, set, placed);
    certify_charts(run, whole, set.charts, placed);
    // Places of tiles that are no squares in unit squares, as files have them: exact, as the sides are powers of two.
    if (params.packing.aspect != 1)
        for (vec2& x : placed.uv) x.y /= params.packing.aspect;
    return {std::move(set.charts), std::move(placed.uv), std::move(placed.layout), std::move(run.report)};
}

} // namespace taut::impl

namespace taut
{

atlas make_atlas(queue& q, const mesh<triangle>& m, const atlas_params& params, const run_limits& limits)
{
    limits.validate();
    impl::require(m, params);
    const double unit = impl::unit_scale(m);
    if (!(unit > 1e70 || unit < 1e-70)) return impl::atlas_in_range(q, m, params, limits);
    atlas_params of_scaled = params;
    of_scaled.packing.texels_per_unit /= unit;
    atlas made = impl::atlas_in_range(q, impl::scaled(m, unit), of_scaled, limits);
    made.charts.surface = impl::scaled(made.charts.surface, 1 / unit);
    made.layout.scale *= unit;
    for (auto& place : made.layout.places) place.scale *= unit;
    made.report.seam_length /= unit;
    made.report.area /= unit * unit;
    if (made.report.symmetry) made.report.symmetry->offset /= unit;
    for (auto& chart : made.report.charts) chart.area /= unit * unit;
    return made;
}

std::ostream& operator<<(std::ostream& out, const atlas_report& r)
{
    if (!r.reason.empty()) return out << "no valid atlas: " << r.reason;
    return out << r.charts.size() << (r.charts.size() == 1 ? " chart, E " : " charts, E ") << r.distortion << ", "
               << static_cast<int>(100 * r.utilization) << " % of the square, " << r.flips.flipped << " flipped, "
               << r.overlaps << " overlaps";
}

} // namespace taut
