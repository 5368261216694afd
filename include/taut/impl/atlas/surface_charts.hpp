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

#include <taut/impl/atlas/cluster_tree.hpp>
#include <taut/impl/atlas/laid_shape.hpp>
#include <taut/impl/atlas/seams/seam_arcs.hpp>
#include <taut/impl/atlas/segment.hpp>
#include <taut/impl/atlas/surface_part.hpp>

namespace taut::impl
{

/// Charts of a surface with their maps, and their replacement in cuts and unions.
class surface_charts
{
public:
    surface_charts(const mesh<triangle>& m, const facet_table& f, const charts_to_maps& flatten,
                   const segment_params& params)
        : mesh_(m),
          facets_(f),
          flatten_(flatten),
          params_(params),
          budget_(params.limits.time_limit, params.limits.observer),
          seam_(f.twin.size(), 0),
          uv_(f.twin.size(), vec2(0.0)),
          chart_(m.cells().size(), 0),
          number_(m.points().size(), -1),
          place_(m.cells().size(), -1),
          area_(m.cells().size())
    {
        for (std::size_t c = 0; c < area_.size(); ++c)
        {
            const auto x = m.rest(static_cast<idx>(c));
            area_[c] = glm::length(glm::cross(x[1] - x[0], x[2] - x[0])) / 2;
        }
        total_area_ = std::accumulate(area_.begin(), area_.end(), 0.0);
    }

protected:
    static constexpr double infinite = std::numeric_limits<double>::infinity();

    struct record
    {
        double area = 0, energy = 4;
        laid_shape shape;
        std::vector<idx> triangles; // ascending; none: there is no such chart any more
        char settled = 1;           // its map is that of least energy
        char strained = 1;          // of one that is cut: there is too much distortion, or it is ragged

        double excess() const { return area * (energy - 4); }
    };

    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    bool proceed(int round) { return budget_.proceed({.iteration = round, .value = 4 + total_excess() / total_area_}); }

    double allowed() const { return (params_.mean_distortion - 4) * total_area_; }

    /// Total excess of distortion over the charts that have a map.
    double total_excess() const
    {
        double sum = 0;
        for (const record& r : charts_)
            if (!r.triangles.empty() && r.energy < infinite) sum += r.excess();
        return sum;
    }

    /// Share of a chart in the total distortion that is allowed. Pieces of a chart above the bound will be below it.
    double to_share(const record& r) const
    {
        return r.energy < infinite ? std::min(r.excess(), (params_.max_distortion - 4) * r.area) : 0;
    }

    /// Number of triangles below each node of a tree.
    static std::vector<idx> triangles_below(const cluster_tree& tree)
    {
        std::vector<idx> triangles(u(tree.nodes()), 0);
        for (idx n = 0; n < tree.nodes(); ++n)
        {
            if (n < tree.triangles) triangles[u(n)] = 1;
            if (const idx parent = tree.parents[u(n)]; parent != cluster_tree::none)
                triangles[u(parent)] += triangles[u(n)];
        }
        return triangles;
    }

    /// Flattens some of the pieces of an antichain, and calls told(node, energy, overlaps itself).
    template <class Told>
    void flatten_some(const mesh<triangle>& m, const facet_table& f, const cluster_tree& tree,
                      const std::vector<char>& antichain, const std::vector<char>& some, Told&& told)
    {
        const auto label = tree.labels(some);
        std::vector<idx> triangles;
        for (idx c = 0; c < tree.triangles; ++c)
            if (label[u(c)] != cluster_tree::none) triangles.push_back(c);
        std::vector<idx> number(m.points().size(), -1);
        const surface_part part = part_of(m, triangles, tree.seams(f, tree.labels(antichain)), number);
        const auto [maps, shapes] = flatten(part);
        for (idx k = 0; k < part.charts.charts(); ++k)
            told(label[u(part.triangles[u(part.charts.first_cell[u(k)])])], maps.energy[u(k)], shapes[u(k)].crosses);
    }

    /// Rebuilds the charts of these triangles from the seams, with their maps.
    void renew(std::span<const idx> triangles)
    {
        for (const idx c : triangles)
            if (!charts_.empty()) charts_[u(chart_[u(c)])].triangles.clear();
        const surface_part part = part_of(mesh_, triangles, seam_, number_);
        const auto [maps, shapes] = flatten(part);
        for (idx k = 0; k < part.charts.charts(); ++k) take(part, maps, shapes[u(k)], k);
    }

    std::pair<chart_maps, std::vector<laid_shape>> flatten(const surface_part& part, std::span<const vec2> start = {})
    {
        budget_.lap();
        chart_maps maps = flatten_(part.charts, start);
        report_.flatten_seconds += budget_.lap();
        auto shapes = laid_shapes(part.charts, maps.uv, maps.energy, budget_.proceed()); // of a run that ends now, less
        return {std::move(maps), std::move(shapes)};
    }

    /// Takes chart k of a part, with its map.
    void take(const surface_part& part, const chart_maps& maps, const laid_shape& shape, idx k)
    {
        record r{
            .area = 0, .energy = maps.energy[u(k)], .shape = shape, .triangles = {}, .settled = maps.settled[u(k)]};
        for (auto& pair : r.shape.meetings)
            for (idx& c : pair) c = part.triangles[u(c)];
        for (auto i = u(part.charts.first_cell[u(k)]); i < u(part.charts.first_cell[u(k) + 1]); ++i)
        {
            const idx c = part.triangles[i];
            chart_[u(c)] = static_cast<idx>(charts_.size());
            r.area += area_[u(c)];
            r.triangles.push_back(c);
            for (std::size_t j = 0; j < 3; ++j) uv_[3 * u(c) + j] = maps.uv[u(part.charts.surface.cells()[i][j])];
        }
        charts_.push_back(std::move(r));
    }

    /// The triangles of charts, ascending.
    std::vector<idx> triangles_of(std::span<const idx> charts) const
    {
        std::vector<idx> triangles;
        for (const idx k : charts)
            triangles.insert(triangles.end(), charts_[u(k)].triangles.begin(), charts_[u(k)].triangles.end());
        std::sort(triangles.begin(), triangles.end());
        return triangles;
    }

    /// Finishes the maps of the remaining charts.
    void settle()
    {
        std::vector<idx> some;
        for (idx k = 0; k < static_cast<idx>(charts_.size()); ++k)
            if (!charts_[u(k)].settled && !charts_[u(k)].triangles.empty()) some.push_back(k);
        if (some.empty() || !budget_.proceed()) return;
        const auto triangles = triangles_of(some);
        const surface_part part = part_of(mesh_, triangles, seam_, number_);
        std::vector<vec2> start(part.charts.surface.points().size());
        for (std::size_t i = 0; i < part.triangles.size(); ++i)
            for (std::size_t j = 0; j < 3; ++j)
                start[u(part.charts.surface.cells()[i][j])] = uv_[3 * u(part.triangles[i]) + j];
        const auto [maps, shapes] = flatten(part, start);
        for (idx k = 0; k < part.charts.charts(); ++k)
        {
            record& before = charts_[u(chart_[u(part.triangles[u(part.charts.first_cell[u(k)])])])];
            if (!(maps.energy[u(k)] <= before.energy)) continue; // the time was over before its turn
            before.triangles.clear();
            take(part, maps, shapes[u(k)], k);
        }
    }

    /// Joins two charts, or one given twice, as they are.
    record before(const std::array<idx, 2>& charts) const
    {
        const record &a = charts_[u(charts[0])], &b = charts_[u(charts[1])];
        if (charts[0] == charts[1])
            return {.area = a.area, .energy = a.energy, .shape = {a.shape.crosses, a.shape.fill, {}}, .triangles = {}};
        const double area = a.area + b.area;
        return {.area = area,
                .energy = 4 + (a.excess() + b.excess()) / area,
                .shape = {false, std::min(a.shape.fill, b.shape.fill), {}},
                .triangles = {}};
    }

    double length(std::size_t side) const
    {
        const auto [a, b] = side_vertices(mesh_, static_cast<idx>(side));
        return glm::distance(mesh_.points()[u(a)], mesh_.points()[u(b)]);
    }

    uncut_segmentation result()
    {
        uncut_segmentation r;
        double area = 0;
        for (const record& one : charts_)
        {
            if (one.triangles.empty() || !(one.energy < infinite)) continue;
            area += one.area;
            report_.largest_distortion = std::max(report_.largest_distortion, one.energy);
        }
        if (area > 0) report_.distortion = 4 + total_excess() / area;
        r.laid.energy.reserve(chart_.size());
        r.crosses.reserve(chart_.size());
        for (const idx k : chart_)
        {
            r.laid.energy.push_back(charts_[u(k)].energy);
            r.crosses.push_back(charts_[u(k)].shape.crosses);
        }
        report_.total_seconds = budget_.total();
        r.laid.seam = std::move(seam_);
        r.laid.uv = std::move(uv_);
        r.report = report_;
        return r;
    }

    const mesh<triangle>& mesh_;
    const facet_table& facets_;
    const charts_to_maps& flatten_;
    const segment_params& params_;
    budget budget_;
    segment_report report_;
    std::vector<char> seam_;  // one per side
    std::vector<vec2> uv_;    // one per corner
    std::vector<idx> chart_;  // one per triangle: its record
    std::vector<idx> number_; // for part_of()
    csr sides_;               // that start at each vertex, once they are asked for
    std::vector<idx> place_;  // of triangles in the part that is cut
    std::vector<double> area_;
    double total_area_ = 0;
    std::vector<record> charts_;
    std::vector<std::array<idx, 2>> refused_; // pairs that the bounds did not allow, ascending
};

} // namespace taut::impl
