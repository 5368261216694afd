// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <taut/impl/atlas/atlas_summary.hpp>
#include <taut/impl/atlas/crossing_charts.hpp>
#include <taut/impl/atlas/filled_square.hpp>
#include <taut/impl/atlas/flat_charts.hpp>
#include <taut/impl/atlas/make_atlas.hpp>
#include <taut/impl/atlas/pinned_charts.hpp>
#include <taut/impl/atlas/settled_charts.hpp>
#include <taut/impl/atlas/short_charts.hpp>
#include <taut/impl/atlas/stacked_charts.hpp>
#include <taut/impl/exact/convex_polygons.hpp>
#include <taut/impl/packing/certificate.hpp>
#include <taut/impl/packing/outlines.hpp>
#include <taut/impl/packing/pieces.hpp>
#include <taut/impl/untangle/convex_corners.hpp>

namespace taut::impl
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
        fill_better();
        lay();
        settle();
        note_enlarged();
        if (mirror_)
        {
            const auto [pairs, own] = count_mirrored(*charts_, *mirror_);
            report_.symmetry = {mirror_->normal, mirror_->offset, pairs, own};
        }
        certify_all({});
        fill_squares();
        return {std::move(*charts_), std::move(uv_), std::move(layout_), std::move(report_)};
    }

    /// Joins the pinned charts of this surface with an atlas of the rest, certified together.
    atlas with(const pinned_charts& pins, atlas made)
    {
        budget_.lap(); // what the rest took is in its report
        made = pins.joined(std::move(made));
        report_ = std::move(made.report);
        std::vector<char> pinned(report_.charts.size(), 0);
        pinned.resize(pinned.size() + static_cast<std::size_t>(pins.charts()), 1);
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
        certify_all(pinned);
        return {std::move(*charts_), std::move(uv_), std::move(layout_), std::move(report_)};
    }

private:
    /// Cuts charts where the square is used much better then for the length of the cuts (filled_square.hpp).
    void fill_better()
    {
        constexpr double least_length = 0.1, by_seams = 0.08; // that may be cut in all, by the root of the area
        constexpr idx few = 16;                               // charts
        const auto& packing = params_.packing;
        if (params_.prefer != chart_preference::seams || params_.keep_charts || params_.symmetric || params_.stack ||
            !packing.walls.empty() || packing.on_grid() || packing.tiles > 1)
            return;
        if (!report_.reason.empty() || !report_.complete || charts_->charts() > few) return;
        const double longest =
            least_length * std::sqrt(surface_area()) + by_seams * length_of_seams(mesh_, facets_, seam_);
        const auto laid = triangles_as_laid();
        const auto prices = side_prices(mesh_, facets_, params_.charts.together, factors_);
        auto quietly = packing;
        quietly.limits = {std::max(budget_.left(), budget::seconds(1e-6)), {}};
        auto seam = filled_square(mesh_, facets_, laid.uv, prices, quietly)
                        .run(seam_, longest, [ask = asking("pack")] { return ask({}); });
        if (seam != seam_)
        {
            seam_ = std::move(seam);
            cut(laid);
            const ideal_elements<triangle> ideal(charts_->surface);
            for (std::size_t k = 0; k < energy_.size(); ++k)
                energy_[k] = area_and_energy(*charts_, k, flat_, ideal).second;
        }
        report_.seconds.pack += budget_.lap();
    }

    double surface_area() const
    {
        double sum = 0;
        for (const double a : ideal_elements<triangle>(mesh_).measure) sum += a;
        return sum;
    }

    /// Makes polygons that are convex in space convex in the plane; at first with free borders, and with fixed ones in
    /// charts that overlap themselves then. Charts that are to stay are moved as little as possible.
    void make_convex()
    {
        if (params_.keep_charts && !params_.relax)
        {
            settle_charts(*charts_, polygons_, flat_, {});
            return;
        }
        const auto label = polygon_labels();
        const auto before = flat_;
        fixed_marks<2> held(flat_.size());
        for (int round = 0; round < 2; ++round)
        {
            if (!convex_corners(charts_->surface, label, polygons_, held,
                                [this] { return report_.complete && budget_.in_time(); })
                     .make_convex(flat_))
                return;
            const auto first = [this](std::size_t k) { return charts_->first_vertex[k]; };
            for (std::size_t k = 0; k < u(charts_->charts()); ++k)
            {
                const auto own = flat_.begin() + first(k), end = flat_.begin() + first(k + 1);
                if (std::equal(own, end, before.begin() + first(k)) || !overlaps_itself(*charts_, k, flat_)) continue;
                std::copy(before.begin() + first(k), before.begin() + first(k + 1), own);
                for_each_border_side(*charts_, static_cast<idx>(k),
                                     [&](idx from, idx) { held[u(from)] = fixed_marks<2>::every; });
            }
        }
    }

    /// Packs charts into the tiles, rounded as in the file.
    void lay()
    {
        if (!report_.reason.empty())
        {
            uv_ = flat_;
            return;
        }
        // There is room for it: nothing is beside a chart yet.
        polygons_ = convex();
        if (polygons_.size() > 0) make_convex();
        auto params = params_.packing;
        params.limits = {std::max(budget_.left(), budget::seconds(1e-6)), asking("pack")};
        params.densities = densities_of(*charts_);
        params.groups = groups_of(*charts_);
        stacks_.reset();
        if (params_.stack)
        {
            stacks_.emplace(*charts_, params.groups);
            stacks_->take_best(flat_, energy_);
            stacks_->share(flat_);
            report_.stacked = charts_->charts() - static_cast<idx>(stacks_->leaders().size());
        }
        const idx rows = (params.tiles + 9) / 10;
        const double step =
            spacing_at(params_.origin + vec2(std::min(params.tiles, 10), rows * std::max(params.aspect, 1.0)) - 0.25,
                       params_.stored);
        params.rounding = std::max(params.rounding, 4 * step); // so far vertices may be moved
        outlines_ = find_outlines(flat_, charts_->surface.cells(), charts_->first_cell, charts_->first_vertex);
        if (stacks_)
        {
            params.densities = stacks_->of_leaders(params.densities);
            params.groups = stacks_->of_leaders(params.groups);
            layout_ = pack_outlined(flat_, stacks_->first_outlines(outlines_), params);
            layout_.places = stacks_->of_all(layout_.places);
        }
        else
            layout_ = pack_outlined(flat_, outlines_, params);
        report_.complete = report_.complete && layout_.complete;
        uv_ = layout_.apply(flat_, charts_->first_vertex);
        for (std::size_t k = 0; k < layout_.places.size(); ++k) // rows of ten tiles
        {
            const idx tile = layout_.places[k].tile, row = tile / 10;
            for (auto v = u(charts_->first_vertex[k]); v < u(charts_->first_vertex[k + 1]); ++v)
                uv_[v] += vec2(params_.origin.x - 10 * row, (params_.origin.y + row) * params.aspect);
        }
        bad_ = settle_charts(*charts_, polygons_, uv_, {.stored = params_.stored, .reach = params.rounding});
        if (stacks_)
        {
            stacks_->share(uv_);
            bad_ = stacks_->of_all(stacks_->of_leaders(bad_));
        }
        report_.seconds.pack += budget_.lap();
    }

    /// Replaces charts that rounding makes invalid and that cannot be corrected in place: by larger ones, if they are
    /// small for the digits of the file, else by smaller patches.
    void settle()
    {
        constexpr int most_rounds = 32; // places change for all charts, and so do the digits of those that were good
        for (int round = 0; round < most_rounds; ++round)
        {
            if (!report_.reason.empty() || std::count(bad_.begin(), bad_.end(), char(1)) == 0) return;
            auto bad = bad_;
            for (std::size_t k = 0; k < bad.size(); ++k)
                if (bad[k] && enlarge(k)) bad[k] = 0;
            if (round == 0 && !params_.keep_charts && report_.complete) keep_touching_apart(bad);
            idx largest = 0; // of those that are left
            for (std::size_t k = 0; k < bad.size(); ++k)
                if (bad[k]) largest = std::max(largest, charts_->first_cell[k + 1] - charts_->first_cell[k]);
            if (largest > 0)
            {
                take_apart(bad, std::clamp<std::size_t>(u(largest) / 4, 1, 1024));
                join_polygons();
            }
            if (report_.reason.empty()) lay();
        }
    }

    /// Maps charts anew of which rounding makes the border meet itself, but flattens no triangle: those of plain shapes
    /// touch themselves. Clears their flags.
    void keep_touching_apart(std::vector<char>& bad)
    {
        std::vector<char> touching(bad.size());
        for (std::size_t k = 0; k < bad.size(); ++k) touching[k] = bad[k] && turned_triangle(*charts_, k, uv_) < 0;
        const auto before = touching;
        keep_apart(touching);
        for (std::size_t k = 0; k < bad.size(); ++k)
            if (before[k]) bad[k] = touching[k];
    }

    /// Scales a chart up if its triangles are not much larger than the units of the file's numbers. Returns whether it
    /// did.
    bool enlarge(std::size_t k)
    {
        const std::span own(uv_.data() + charts_->first_vertex[k], uv_.data() + charts_->first_vertex[k + 1]);
        vec2 low = own.front(), high = low;
        for (const vec2& p : own)
        {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        const idx first = charts_->first_cell[k], end = charts_->first_cell[k + 1];
        const double wanted = 256 * std::sqrt(static_cast<double>(end - first)) * spacing_at(high, params_.stored);
        const double size = glm::length(high - low);
        if (size >= wanted) return false;
        grown_.resize(mesh_.cells().size(), 1.0);
        for (auto i = u(first); i < u(end); ++i)
            grown_[u(charts_->cell_origins[i])] *= std::min(1e9, 2 * wanted / std::max(size, wanted * 1e-9));
        return true;
    }

    void note_enlarged()
    {
        const auto densities = densities_of(*charts_);
        const auto count = std::count_if(densities.begin(), densities.end(), [](double x) { return x > 1; });
        if (count > 0)
            report_.notes.push_back(std::to_string(count) + (count == 1 ? " chart is" : " charts are") +
                                    " scaled up, as the numbers of the file are too coarse for " +
                                    (count == 1 ? "it" : "them"));
    }

    /// Texel density of each chart relative to the others; empty if all are equal.
    std::vector<double> densities_of(const chart_mesh& charts) const
    {
        std::vector<double> densities;
        if (grown_.empty()) return densities;
        for (std::size_t k = 0; k < u(charts.charts()); ++k)
            densities.push_back(grown_[u(charts.cell_origins[u(charts.first_cell[k])])]);
        return densities;
    }

    /// The tile of each chart; empty: any.
    std::vector<idx> groups_of(const chart_mesh& charts) const
    {
        std::vector<idx> groups;
        if (params_.groups.empty()) return groups;
        for (std::size_t k = 0; k < u(charts.charts()); ++k)
            groups.push_back(params_.groups[u(charts.cell_origins[u(charts.first_cell[k])])]);
        return groups;
    }

    /// Places of tiles that are no squares in unit squares, as files have them: exact, as the sides are powers of two.
    void fill_squares()
    {
        if (params_.packing.aspect == 1) return;
        for (vec2& x : uv_) x.y /= params_.packing.aspect;
    }

    /// The polygon of each triangle of the charts; empty: all are triangles.
    std::vector<idx> polygon_labels() const
    {
        if (params_.charts.together.empty()) return {};
        const auto polygon = polygons_of(facets_, params_.charts.together);
        std::vector<idx> label(charts_->cell_origins.size());
        for (std::size_t i = 0; i < label.size(); ++i) label[i] = polygon[u(charts_->cell_origins[i])];
        return label;
    }

    /// The polygons of charts that are convex in space.
    convex_polygons convex() const
    {
        return find_convex_polygons(charts_->surface.cells(), polygon_labels(), charts_->surface.points());
    }

    /// pinned: as for certify_packing()
    void certify_all(std::span<const char> pinned)
    {
        const auto& cut = charts_->surface;
        summarize(report_, *charts_, uv_, layout_);
        report_.tiles = layout_.tiles > 0 ? layout_.tiles : params_.packing.tiles;
        report_.resolution = layout_.resolution > 0 ? layout_.resolution : params_.packing.resolution;
        report_.seam_length = length_of_seams(mesh_, facets_, seam_);
        if (!open_.empty() && report_.seam_length > 0) report_.seen_seam = seen_length() / report_.seam_length;
        if (!report_.reason.empty()) return;
        report_.flips = certify<2>(cut.cells(), std::span<const vec2>(uv_));
        if (!report_.flips || outlines_.turned || outlines_.charts() != charts_->charts())
            outlines_ = find_outlines(uv_, cut.cells(), charts_->first_cell, charts_->first_vertex);
        // Copies are where the first ones are.
        const auto sealed = certify_outlined(uv_, cut.cells(), stacks_ ? stacks_->first_outlines(outlines_) : outlines_,
                                             pinned, params_.packing.aspect);
        if (!pinned.empty()) polygons_ = convex();
        report_.polygons = u(polygons_.size());
        report_.concave = find_concave(polygons_, uv_).size();
        const auto crossing = crossing_charts(*charts_, uv_);
        report_.overlaps =
            sealed.overlaps.pairs + static_cast<std::size_t>(std::count(crossing.begin(), crossing.end(), char(1)));
        report_.least_distance = std::min(sealed.gap, sealed.border) * report_.resolution;
        report_.seconds.certify += budget_.lap();
        auto& named = report_.reason_triangles;
        if (!report_.flips)
        {
            for (const idx c : report_.flips.ids) named.push_back(charts_->cell_origins[u(c)]);
            report_.reason = std::to_string(report_.flips.flipped) + " triangles" + turned_ids() +
                             " are flipped by the digits of the file; " + remedy;
        }
        else if (const auto bad = std::find(crossing.begin(), crossing.end(), char(1)); bad != crossing.end())
        {
            named = {first_triangle(static_cast<std::size_t>(bad - crossing.begin()))};
            report_.reason = "the border of chart " + std::to_string(bad - crossing.begin()) + ", that of triangle " +
                             std::to_string(named[0]) + ", meets itself in the digits of the file; " + remedy;
        }
        else if (report_.overlaps > 0)
        {
            for (const idx k : sealed.overlaps.first) named.push_back(first_triangle(laid_chart(k)));
            report_.reason = std::to_string(report_.overlaps) +
                             " charts overlap in the atlas: the first are those of triangles " +
                             std::to_string(named[0]) + " and " + std::to_string(named[1]);
        }
        else if (!sealed.holds(params_.packing.padding, report_.resolution))
            report_.reason = "charts are nearer to each other, or to the border, than the padding";
        if (report_.concave > 0)
            report_.notes.push_back(std::to_string(report_.concave) +
                                    (report_.concave == 1 ? " polygon is" : " polygons are") +
                                    " not convex in the atlas, though in space; cut along other diagonals, triangles "
                                    "of them turn over");
    }

    /// Length of the seams, times how much is seen of their ends.
    double seen_length() const
    {
        double sum = 0;
        for (std::size_t s = 0; s < seam_.size(); ++s)
        {
            if (!seam_[s] || facets_.twin[s] < static_cast<idx>(s)) continue;
            const auto [a, b] = side_vertices(mesh_, static_cast<idx>(s));
            sum += glm::distance(mesh_.points()[u(a)], mesh_.points()[u(b)]) * 0.5 * (open_[u(a)] + open_[u(b)]);
        }
        return sum;
    }

    static constexpr const char* remedy = "a file with more digits (.obj) may keep them, or --upright";

    /// The chart of a certificate, which has the first of each stack.
    std::size_t laid_chart(idx k) const { return u(stacks_ ? stacks_->leaders()[u(k)] : k); }

    idx first_triangle(std::size_t chart) const { return charts_->cell_origins[u(charts_->first_cell[chart])]; }

    /// " (3, 8, ...)", as the surface numbers them.
    std::string turned_ids() const
    {
        std::string text;
        for (const idx c : report_.flips.ids)
            text += (text.empty() ? " (" : ", ") + std::to_string(charts_->cell_origins[u(c)]);
        return text.empty() ? text : text + (report_.flips.flipped > report_.flips.ids.size() ? ", ...)" : ")");
    }

    std::vector<char> bad_;     // one per chart: whether it is not valid as it is laid
    convex_polygons polygons_;  // of the charts
    std::vector<double> grown_; // one per triangle of the surface: how much larger its chart is laid; empty if none is
    std::vector<vec2> uv_;      // one per vertex of the charts, in the tiles
    packing layout_;
    std::optional<stacked_charts> stacks_;
    chart_outlines outlines_; // of the charts as they were laid; the same in the tiles, unless triangles turned over
};

} // namespace taut::impl

namespace taut
{

atlas make_atlas(queue& q, const mesh<triangle>& m, const atlas_params& params)
{
    // Beyond these sizes areas, or products of them, would overflow.
    if (const double unit = impl::unit_scale(m); unit > 1e70 || unit < 1e-70)
    {
        atlas_params of_scaled = params;
        of_scaled.packing.texels_per_unit /= unit;
        atlas made = make_atlas(q, impl::scaled(m, unit), of_scaled);
        made.charts.surface = impl::scaled(made.charts.surface, 1 / unit);
        made.layout.scale *= unit;
        for (auto& place : made.layout.places) place.scale *= unit;
        made.report.seam_length /= unit;
        made.report.area /= unit * unit;
        if (made.report.symmetry) made.report.symmetry->offset /= unit;
        for (auto& chart : made.report.charts) chart.area /= unit * unit;
        return made;
    }
    if (params.symmetric && (params.keep_charts || !params.pinned.empty()))
        throw parameter_error("symmetric", "makes charts; none can be kept or pinned");
    if (params.symmetric && params.stack)
        throw parameter_error("stack", "is of copies, and mirror images are none; leave out `symmetric`");
    if (!params.wishes.weights.empty() && (params.symmetric || !params.pinned.empty()))
        throw parameter_error("weights", "are of the whole surface; leave out `symmetric` and `pinned`");
    if (!params.groups.empty() && params.groups.size() != m.cells().size())
        throw parameter_error("groups", "empty or one tile a triangle");
    if (params.stack && !params.pinned.empty())
        throw parameter_error("stack", "is of charts that are placed; pin none");
    if (!params.pinned.empty() && params.packing.aspect != 1)
        throw parameter_error("aspect", "pinned charts lie in squares; give 1, or pin none");
    impl::atlas_making whole(q, m, params);
    if (std::count(params.pinned.begin(), params.pinned.end(), char(0)) ==
        static_cast<std::ptrdiff_t>(params.pinned.size()))
        return whole.run();
    impl::pinned_charts::require(m, params);
    const auto f = impl::facets(m);
    validate(m, f, impl::atlas_requirements);
    const impl::pinned_charts pins(m, f, params);
    std::vector<char> seams, together;
    const atlas_params of_rest = pins.of_rest(seams, together);
    return whole.with(pins, impl::atlas_making(q, pins.rest(), of_rest).run());
}

} // namespace taut
