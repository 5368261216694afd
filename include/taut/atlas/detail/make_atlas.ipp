// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/atlas/detail/crossing_charts.hpp>
#include <taut/atlas/make_atlas.hpp>
#include <taut/core/budget.hpp>
#include <taut/energy/isometric.hpp>
#include <taut/mesh/ideal.hpp>
#include <taut/mesh/validate.hpp>
#include <taut/packing/certificate.hpp>

namespace taut::detail
{

/// One run of make_atlas(), phase by phase.
class atlas_making
{
public:
    atlas_making(queue& q, const mesh<triangle>& m, const atlas_params& params)
        : queue_(q), mesh_(m), params_(params), facets_(facets(m)), budget_(params.time_limit)
    {
    }

    atlas run()
    {
        validate(mesh_, facets_,
                 {.referenced = false, .connected = false, .open = false, .one_boundary = false, .no_handles = false});
        report_.seconds.setup = budget_.lap();
        if (params_.keep_charts)
            keep_charts();
        else
            make_charts();
        budget_.has_result(true);
        lay();
        certify_all();
        return {std::move(*charts_), std::move(uv_), std::move(layout_), std::move(report_)};
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// Asks whether to go on, in a stage.
    observer asking(std::string_view stage)
    {
        return [this, stage](const progress& p)
        {
            const bool in_time = budget_.in_time();
            const bool wanted = !params_.observer || params_.observer({.stage = stage,
                                                                       .charts = static_cast<idx>(p.iteration),
                                                                       .value = p.value,
                                                                       .seconds = budget_.total(),
                                                                       .usable = usable_});
            report_.complete = report_.complete && in_time && wanted;
            return report_.complete;
        };
    }

    /// All charts at once; those whose borders meet themselves have no map.
    flattened_charts flatten(const chart_mesh& charts, std::span<const vec2> initial = {})
    {
        auto params = params_.flattening;
        params.initial = initial;
        params.time_limit = std::max(budget_.left(), budget::seconds(1e-6));
        params.observer = asking("flatten");
        const double begin = budget_.total();
        auto flat = flatten_charts(queue_, charts, params);
        const auto crossing = crossing_charts(charts, flat.uv);
        for (std::size_t k = 0; k < flat.charts.size(); ++k)
            if (flat.charts[k].valid && crossing[k])
            {
                flat.charts[k].valid = false;
                flat.charts[k].energy = std::numeric_limits<double>::infinity();
                flat.charts[k].reason = "its border meets itself";
            }
        report_.seconds.flatten += budget_.total() - begin;
        return flat;
    }

    void make_charts()
    {
        auto params = params_.charts;
        params.time_limit = std::max(budget_.left(), budget::seconds(1e-6));
        params.observer = asking("charts");
        auto made = segment(
            mesh_, facets_,
            [this](const chart_mesh& charts)
            {
                auto flat = flatten(charts);
                usable_ = true;
                return flat;
            },
            params);
        report_.seconds.charts = budget_.lap() - report_.seconds.flatten;
        seam_ = std::move(made.seam);
        charts_.emplace(std::move(made.charts));
        uv_ = std::move(made.uv);
        energy_ = std::move(made.energy);
        if (made.report.unmapped > 0) take_apart();
    }

    /// Charts without a map, which is what those are for whom there was no time, become single triangles.
    void take_apart()
    {
        idx apart = 0;
        std::vector<char> mapped(mesh_.cells().size(), 1);
        std::vector<std::array<vec2, 3>> uv(mesh_.cells().size());
        std::vector<double> energy(mesh_.cells().size());
        for (std::size_t k = 0; k < energy_.size(); ++k)
        {
            const bool valid = energy_[k] < std::numeric_limits<double>::infinity();
            apart += valid ? 0 : 1;
            for (auto i = u(charts_->first_cell[k]); i < u(charts_->first_cell[k + 1]); ++i)
            {
                const auto c = u(charts_->cell_origins[i]);
                mapped[c] = valid;
                energy[c] = valid ? energy_[k] : 4;
                const auto x = mesh_.rest(static_cast<idx>(c));
                const mat2 W = stiff_ideal(x[1] - x[0], x[2] - x[0]);
                for (std::size_t j = 0; j < 3; ++j)
                    uv[c][j] = valid    ? uv_[u(charts_->surface.cells()[i][j])]
                               : j == 0 ? vec2(0.0)
                                        : W[static_cast<int>(j) - 1];
            }
        }
        for (std::size_t s = 0; s < seam_.size(); ++s) seam_[s] = seam_[s] != 0 || mapped[s / 3] == 0;
        charts_.emplace(cut_charts(mesh_, facets_, seam_));
        uv_.assign(charts_->surface.points().size(), vec2(0.0));
        energy_.clear();
        for (std::size_t k = 0; k + 1 < charts_->first_cell.size(); ++k)
        {
            energy_.push_back(energy[u(charts_->cell_origins[u(charts_->first_cell[k])])]);
            for (auto i = u(charts_->first_cell[k]); i < u(charts_->first_cell[k + 1]); ++i)
                for (std::size_t j = 0; j < 3; ++j)
                    uv_[u(charts_->surface.cells()[i][j])] = uv[u(charts_->cell_origins[i])][j];
        }
        report_.notes.push_back(std::to_string(apart) + (apart == 1 ? " chart" : " charts") +
                                " without a map became single triangles");
    }

    void keep_charts()
    {
        seam_.assign(params_.charts.seams.begin(), params_.charts.seams.end());
        seam_.resize(facets_.twin.size(), 0);
        charts_.emplace(cut_charts(mesh_, facets_, seam_));
        std::vector<vec2> initial(params_.initial.empty() ? 0 : charts_->surface.points().size());
        if (!initial.empty())
            for (std::size_t i = 0; i < charts_->cell_origins.size(); ++i)
                for (std::size_t j = 0; j < 3; ++j)
                    initial[u(charts_->surface.cells()[i][j])] = params_.initial[u(charts_->cell_origins[i])][j];
        auto flat = flatten(*charts_, initial);
        report_.seconds.charts = budget_.lap() - report_.seconds.flatten;
        for (std::size_t k = 0; k < flat.charts.size(); ++k)
        {
            energy_.push_back(flat.charts[k].energy);
            if (flat.charts[k].valid || !report_.reason.empty()) continue;
            report_.reason = "the chart of triangle " +
                             std::to_string(charts_->cell_origins[u(charts_->first_cell[k])]) +
                             " cannot be kept: " + flat.charts[k].reason + "; let charts be made";
        }
        uv_ = std::move(flat.uv);
    }

    void lay()
    {
        if (!report_.reason.empty()) return;
        usable_ = true;
        auto params = params_.packing;
        params.time_limit = std::max(budget_.left(), budget::seconds(1e-6));
        params.observer = asking("pack");
        const auto& cut = charts_->surface;
        layout_ = pack(uv_, cut.cells(), charts_->first_cell, charts_->first_vertex, params);
        report_.complete = report_.complete && layout_.complete;
        uv_ = layout_.apply(uv_, charts_->first_vertex);
        for (std::size_t k = 0; k < layout_.places.size(); ++k) // rows of ten tiles
        {
            const idx tile = layout_.places[k].tile, row = tile / 10;
            if (row == 0) continue;
            for (auto v = u(charts_->first_vertex[k]); v < u(charts_->first_vertex[k + 1]); ++v)
                uv_[v] += vec2(-10 * row, row);
        }
        if (params_.stored != nullptr)
            for (vec2& x : uv_) x = params_.stored(x);
        report_.seconds.pack = budget_.lap();
    }

    void certify_all()
    {
        const auto& cut = charts_->surface;
        summarize();
        if (!report_.reason.empty()) return;
        report_.flips = certify<2>(cut.cells(), std::span<const vec2>(uv_));
        const auto sealed = certify_packing(uv_, cut.cells(), charts_->first_cell, charts_->first_vertex);
        const auto crossing = crossing_charts(*charts_, uv_);
        report_.overlaps =
            sealed.overlaps.pairs + static_cast<std::size_t>(std::count(crossing.begin(), crossing.end(), char(1)));
        report_.least_distance = std::min(sealed.gap, sealed.border) * params_.packing.resolution;
        report_.seconds.certify = budget_.lap();
        if (!report_.flips)
            report_.reason = std::to_string(report_.flips.flipped) +
                             " triangles are flipped where charts lie in their square: it has too few digits for them";
        else if (report_.overlaps > 0)
            report_.reason = std::to_string(report_.overlaps) + " charts overlap in the atlas";
        else if (!sealed.holds(params_.packing.padding, params_.packing.resolution))
            report_.reason = "charts are nearer to each other, or to the border, than the padding";
    }

    void summarize()
    {
        const auto& cut = charts_->surface;
        const ideal_elements<triangle> ideal(cut);
        double in_space = 0, in_plane = 0;
        for (std::size_t k = 0; k + 1 < charts_->first_cell.size(); ++k)
        {
            chart_summary chart{.triangles = charts_->first_cell[k + 1] - charts_->first_cell[k],
                                .tile = layout_.places.empty() ? 0 : layout_.places[k].tile,
                                .energy = energy_[k]};
            for (auto c = u(charts_->first_cell[k]); c < u(charts_->first_cell[k + 1]); ++c)
            {
                chart.area += ideal.measure[c];
                const auto& t = cut.cells()[c];
                in_plane += orient(uv_[u(t[0])], uv_[u(t[1])], uv_[u(t[2])]).det / 2;
            }
            in_space += chart.area;
            report_.worst = std::max(report_.worst, chart.energy);
            report_.charts.push_back(chart);
        }
        const double scale = std::sqrt(in_space / in_plane);
        double sum = 0;
        for (std::size_t c = 0; c < cut.cells().size(); ++c)
        {
            const mat2 S = scale * shape_matrix<2>(cut.cells()[c], std::span<const vec2>(uv_), ideal.inverse[c]);
            const double det = glm::determinant(S);
            sum += ideal.measure[c] * (det > 0 ? energy::isometric{}(element<double, 2>{S, det, ideal.measure[c]})
                                               : std::numeric_limits<double>::infinity());
        }
        report_.distortion = sum / in_space;
        report_.utilization = layout_.utilization;
        report_.tiles = params_.packing.tiles;
        for (std::size_t s = 0; s < seam_.size(); ++s)
            if (facets_.twin[s] > static_cast<idx>(s) && seam_[s] != 0)
            {
                const auto [a, b] = side_vertices(mesh_, static_cast<idx>(s));
                report_.seam_length += glm::distance(mesh_.points()[u(a)], mesh_.points()[u(b)]);
            }
    }

    queue& queue_;
    const mesh<triangle>& mesh_;
    const atlas_params& params_;
    facet_table facets_;
    budget budget_;
    atlas_report report_;
    std::vector<char> seam_; // one a side of the surface
    std::optional<chart_mesh> charts_;
    std::vector<vec2> uv_;       // one a vertex of the charts
    std::vector<double> energy_; // one a chart
    packing layout_;
    bool usable_ = false;
};

} // namespace taut::detail

namespace taut
{

TAUT_INLINE atlas make_atlas(queue& q, const mesh<triangle>& m, const atlas_params& params)
{
    return detail::atlas_making(q, m, params).run();
}

} // namespace taut
