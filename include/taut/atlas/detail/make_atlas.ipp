// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/atlas/detail/atlas_summary.hpp>
#include <taut/atlas/detail/crossing_charts.hpp>
#include <taut/atlas/detail/flat_charts.hpp>
#include <taut/atlas/detail/pinned_charts.hpp>
#include <taut/atlas/make_atlas.hpp>
#include <taut/mesh/validate.hpp>
#include <taut/packing/certificate.hpp>
#include <taut/packing/detail/outlines.hpp>

namespace taut::detail
{

/// One run of make_atlas(), phase by phase.
class atlas_making : flat_charts
{
public:
    using flat_charts::flat_charts;

    atlas run()
    {
        validate(mesh_, facets_, atlas_requirements);
        report_.seconds.setup = budget_.lap();
        flat_charts::run();
        lay();
        const auto crossing = part_touching();
        if (mirror_)
        {
            const auto [pairs, own] = count_mirrored(*charts_, *mirror_);
            report_.symmetry = {mirror_->normal, mirror_->offset, pairs, own};
        }
        certify_all(crossing, {});
        return {std::move(*charts_), std::move(uv_), std::move(layout_), std::move(report_)};
    }

    /// The pinned charts of this surface with an atlas of the rest, certified together.
    atlas with(const pinned_charts& pins, atlas made)
    {
        budget_.lap(); // what the rest took is in its report
        made = pins.joined(std::move(made));
        report_ = std::move(made.report);
        for (const auto& chart : report_.charts) energy_.push_back(chart.energy);
        std::vector<char> pinned(energy_.size(), 0);
        for (const double e : pins.energies()) energy_.push_back(e);
        pinned.resize(energy_.size(), 1);
        report_.charts.clear();
        report_.worst = 0;
        charts_.emplace(std::move(made.charts));
        uv_ = std::move(made.uv);
        layout_ = std::move(made.layout);
        layout_.utilization += pins.area() / params_.packing.tiles;
        seam_ = seams_of(*charts_, facets_);
        const auto staying = std::count(pinned.begin(), pinned.end(), char(1));
        report_.notes.push_back(std::to_string(staying) + (staying == 1 ? " chart stays" : " charts stay") + " where " +
                                (staying == 1 ? "it was" : "they were"));
        certify_all(0, pinned);
        return {std::move(*charts_), std::move(uv_), std::move(layout_), std::move(report_)};
    }

private:
    void lay()
    {
        if (!report_.reason.empty())
        {
            uv_ = flat_;
            return;
        }
        auto params = params_.packing;
        params.time_limit = std::max(budget_.left(), budget::seconds(1e-6));
        params.observer = asking("pack");
        outlines_ = find_outlines(flat_, charts_->surface.cells(), charts_->first_cell, charts_->first_vertex);
        layout_ = pack_outlined(flat_, outlines_, params);
        report_.complete = report_.complete && layout_.complete;
        uv_ = layout_.apply(flat_, charts_->first_vertex);
        for (std::size_t k = 0; k < layout_.places.size(); ++k) // rows of ten tiles
        {
            const idx tile = layout_.places[k].tile, row = tile / 10;
            for (auto v = u(charts_->first_vertex[k]); v < u(charts_->first_vertex[k + 1]); ++v)
                uv_[v] += params_.origin + vec2(-10 * row, row);
        }
        if (params_.stored != nullptr)
            for (vec2& x : uv_) x = params_.stored(x);
        report_.seconds.pack += budget_.lap();
    }

    /// Takes charts apart whose borders all but touched, and meet by the rounding of their places. Returns how many
    /// still do.
    std::size_t part_touching()
    {
        std::size_t crossing = 0;
        for (const std::size_t largest : {1024U, 1U, 0U})
        {
            if (!report_.reason.empty()) break;
            const auto touching = crossing_charts(*charts_, uv_);
            crossing = static_cast<std::size_t>(std::count(touching.begin(), touching.end(), char(1)));
            if (crossing == 0 || largest == 0) break;
            take_apart(touching, largest);
            lay();
        }
        return crossing;
    }

    /// crossing: charts that overlap themselves; pinned: as for certify_packing()
    void certify_all(std::size_t crossing, std::span<const char> pinned)
    {
        const auto& cut = charts_->surface;
        summarize(report_, *charts_, uv_, energy_, layout_);
        report_.tiles = params_.packing.tiles;
        report_.seam_length = length_of_seams(mesh_, facets_, seam_);
        if (!report_.reason.empty()) return;
        report_.flips = certify<2>(cut.cells(), std::span<const vec2>(uv_));
        if (!report_.flips || outlines_.turned || outlines_.charts() != charts_->charts())
            outlines_ = find_outlines(uv_, cut.cells(), charts_->first_cell, charts_->first_vertex);
        const auto sealed = certify_outlined(uv_, cut.cells(), outlines_, pinned);
        report_.overlaps = sealed.overlaps.pairs + crossing;
        report_.least_distance = std::min(sealed.gap, sealed.border) * params_.packing.resolution;
        report_.seconds.certify += budget_.lap();
        if (!report_.flips)
            report_.reason = std::to_string(report_.flips.flipped) +
                             " triangles are flipped where charts lie in their square: it has too few digits for them";
        else if (report_.overlaps > 0)
            report_.reason = std::to_string(report_.overlaps) + " charts overlap in the atlas";
        else if (!sealed.holds(params_.packing.padding, params_.packing.resolution))
            report_.reason = "charts are nearer to each other, or to the border, than the padding";
    }

    std::vector<vec2> uv_; // one a vertex of the charts, in the tiles
    packing layout_;
    chart_outlines outlines_; // of the charts as they were laid; the same in the tiles, unless triangles turned over
};

} // namespace taut::detail

namespace taut
{

TAUT_INLINE atlas make_atlas(queue& q, const mesh<triangle>& m, const atlas_params& params)
{
    // Beyond these sizes areas, or products of them, would be no numbers.
    if (const double unit = unit_scale(m); unit > 1e70 || unit < 1e-70)
    {
        atlas made = make_atlas(q, scaled(m, unit), params);
        made.charts.surface = scaled(made.charts.surface, 1 / unit);
        made.layout.scale *= unit;
        for (auto& place : made.layout.places) place.scale *= unit;
        made.report.seam_length /= unit;
        if (made.report.symmetry) made.report.symmetry->offset /= unit;
        for (auto& chart : made.report.charts) chart.area /= unit * unit;
        return made;
    }
    if (params.symmetric && (params.keep_charts || !params.pinned.empty()))
        throw parameter_error("symmetric", "makes charts; none can be kept or pinned");
    detail::atlas_making whole(q, m, params);
    if (std::count(params.pinned.begin(), params.pinned.end(), char(0)) ==
        static_cast<std::ptrdiff_t>(params.pinned.size()))
        return whole.run();
    detail::pinned_charts::require(m, params);
    const auto f = facets(m);
    validate(m, f, atlas_requirements);
    const detail::pinned_charts pins(m, f, params);
    std::vector<char> seams, together;
    const atlas_params of_rest = pins.of_rest(seams, together);
    return whole.with(pins, detail::atlas_making(q, pins.rest(), of_rest).run());
}

} // namespace taut
