// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/cluster_tree.hpp>
#include <taut/impl/charts/atlas/laid_shape.hpp>
#include <taut/impl/charts/atlas/seams/seam_arcs.hpp>
#include <taut/impl/charts/atlas/segment.hpp>
#include <taut/impl/charts/atlas/surface_part.hpp>

namespace taut::impl
{

/// A chart of surface_charts.
struct chart_record
{
    double area = 0, energy = 4;
    laid_shape shape;
    std::vector<idx> triangles; // ascending; none: there is no such chart any more
    char settled = 1;           // its map is that of least energy
    char strained = 1;          // of one that is cut: there is too much distortion, or it is ragged

    double excess() const { return area * (energy - 4); }
};

/// Charts of a surface with their maps while segment() cuts and unites them.
struct surface_charts
{
    surface_charts(const mesh<triangle>& m, const facet_table& f, const charts_to_maps& flatten,
                   const segment_params& how, const run_limits& limits)
        : surface(m),
          facets(f),
          map_charts(flatten),
          params(how),
          clock(limits.time_limit, limits.observer),
          laid{std::vector<char>(f.twin.size(), 0), std::vector<vec2>(f.twin.size(), vec2(0.0)),
               std::vector<double>(m.cells().size(), infinite)},
          chart(m.cells().size(), 0),
          areas(m.cells().size())
    {
        for (std::size_t c = 0; c < areas.size(); ++c)
        {
            areas[c] = triangle_area(m, static_cast<idx>(c));
        }
        total_area = std::accumulate(areas.begin(), areas.end(), 0.0);
    }

    static constexpr double infinite = std::numeric_limits<double>::infinity();

    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    bool proceed(int round) { return clock.proceed({.iteration = round, .value = 4 + total_excess() / total_area}); }

    double allowed() const { return (params.mean_distortion - 4) * total_area; }

    /// Total excess of distortion over the charts that have a map.
    double total_excess() const
    {
        double sum = 0;
        for (const chart_record& r : records)
            if (!r.triangles.empty() && r.energy < infinite) sum += r.excess();
        return sum;
    }

    /// Share of a chart in the total distortion that is allowed. Pieces of a chart above the bound will be below it.
    double to_share(const chart_record& r) const
    {
        return r.energy < infinite ? std::min(r.excess(), (params.max_distortion - 4) * r.area) : 0;
    }

    /// Flattens some of the pieces of an antichain, and calls told(node, energy), which is infinite where a piece
    /// overlaps itself.
    template <class Told>
    void flatten_some(const mesh<triangle>& m, const facet_table& f, const cluster_tree& tree,
                      const std::vector<char>& antichain, const std::vector<char>& some, Told&& told)
    {
        const auto label = tree.labels(some);
        std::vector<char> wanted;
        for (const idx n : label) wanted.push_back(n != cluster_tree::none);
        const surface_part part = part_of(m, wanted, tree.seams(f, tree.labels(antichain)));
        const auto [maps, shapes] = flatten(part);
        for (std::size_t k = 0; k < shapes.size(); ++k)
            told(label[u(part.first_triangle(k))], shapes[k].crosses ? infinite : maps.energy[k]);
    }

    /// Rebuilds the charts of these triangles from the seams, with their maps.
    void renew(std::span<const idx> triangles)
    {
        for (const idx c : triangles)
            if (!records.empty()) records[u(chart[u(c)])].triangles.clear();
        const surface_part part = part_of(surface, triangles, laid.seam);
        const auto [maps, shapes] = flatten(part);
        for (idx k = 0; k < part.charts.charts(); ++k) take(part, maps, shapes[u(k)], k);
    }

    std::pair<chart_maps, std::vector<laid_shape>> flatten(const surface_part& part, std::span<const vec2> start = {})
    {
        chart_maps maps = map_charts(part.charts, start);
        auto shapes = laid_shapes(part.charts, maps.uv, maps.energy, clock.proceed()); // of a run that ends now, less
        return {std::move(maps), std::move(shapes)};
    }

    /// Takes chart k of a part, with its map.
    void take(const surface_part& part, const chart_maps& maps, const laid_shape& shape, idx k)
    {
        chart_record r{
            .area = 0, .energy = maps.energy[u(k)], .shape = shape, .triangles = {}, .settled = maps.settled[u(k)]};
        for (auto& pair : r.shape.meetings)
            for (idx& c : pair) c = part.triangles[u(c)];
        for (auto i = u(part.charts.first_cell[u(k)]); i < u(part.charts.first_cell[u(k) + 1]); ++i)
        {
            const idx c = part.triangles[i];
            chart[u(c)] = static_cast<idx>(records.size());
            r.area += areas[u(c)];
            r.triangles.push_back(c);
        }
        part.write(u(k), r.energy, maps.uv, laid);
        records.push_back(std::move(r));
    }

    /// The triangles of charts, ascending.
    std::vector<idx> triangles_of(std::span<const idx> charts) const
    {
        std::vector<idx> triangles;
        for (const idx k : charts)
            triangles.insert(triangles.end(), records[u(k)].triangles.begin(), records[u(k)].triangles.end());
        std::sort(triangles.begin(), triangles.end());
        return triangles;
    }

    /// Finishes the maps of the remaining charts.
    void settle()
    {
        std::vector<idx> some;
        for (idx k = 0; k < static_cast<idx>(records.size()); ++k)
            if (!records[u(k)].settled && !records[u(k)].triangles.empty()) some.push_back(k);
        if (some.empty() || !clock.proceed()) return;
        const auto triangles = triangles_of(some);
        const surface_part part = part_of(surface, triangles, laid.seam);
        const auto start = part.by_vertex(laid.uv);
        const auto [maps, shapes] = flatten(part, start);
        for (idx k = 0; k < part.charts.charts(); ++k)
        {
            chart_record& before = records[u(chart[u(part.first_triangle(u(k)))])];
            if (!(maps.energy[u(k)] <= before.energy)) continue; // the time was over before its turn
            before.triangles.clear();
            take(part, maps, shapes[u(k)], k);
        }
    }

    /// Joins two charts, or one given twice, as they are.
    chart_record before(const std::array<idx, 2>& charts) const
    {
        const chart_record &a = records[u(charts[0])], &b = records[u(charts[1])];
        if (charts[0] == charts[1])
            return {.area = a.area, .energy = a.energy, .shape = {a.shape.crosses, a.shape.fill, {}}, .triangles = {}};
        const double sum = a.area + b.area;
        return {.area = sum,
                .energy = 4 + (a.excess() + b.excess()) / sum,
                .shape = {false, std::min(a.shape.fill, b.shape.fill), {}},
                .triangles = {}};
    }

    double length(std::size_t side) const
    {
        const auto [a, b] = side_vertices(surface, static_cast<idx>(side));
        return glm::distance(surface.points()[u(a)], surface.points()[u(b)]);
    }

    uncut_segmentation result()
    {
        uncut_segmentation r;
        double mapped = 0;
        for (const chart_record& one : records)
        {
            if (!one.triangles.empty() && one.energy < infinite) mapped += one.area;
        }
        if (mapped > 0) report.distortion = 4 + total_excess() / mapped;
        r.crosses.reserve(chart.size());
        for (const idx k : chart) r.crosses.push_back(records[u(k)].shape.crosses);
        r.laid = std::move(laid);
        r.report = report;
        return r;
    }

    const mesh<triangle>& surface;
    const facet_table& facets;
    const charts_to_maps& map_charts;
    const segment_params& params;
    budget clock;
    segment_report report;
    laid_surface laid;
    std::vector<idx> chart;    // one per triangle: its chart_record
    csr sides;                 // that start at each vertex, once they are asked for
    std::vector<double> areas; ///< of triangles
    double total_area = 0;
    std::vector<chart_record> records;
    std::vector<std::array<idx, 2>> refused; // pairs that the bounds did not allow, ascending
};

} // namespace taut::impl
