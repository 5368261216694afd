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

#include <taut/impl/atlas/atlas_params.hpp>
#include <taut/impl/atlas/atlas_report.hpp>
#include <taut/impl/atlas/atlas_summary.hpp>
#include <taut/impl/atlas/cutting/disk_cells.hpp>
#include <taut/impl/atlas/round_polygon.hpp>
#include <taut/impl/atlas/seams/openness.hpp>
#include <taut/impl/atlas/seams/seam_factors.hpp>
#include <taut/impl/atlas/seen_patches.hpp>
#include <taut/impl/atlas/stacked_charts.hpp>
#include <taut/impl/atlas/surface_part.hpp>
#include <taut/impl/atlas/symmetry/symmetric_half.hpp>
#include <taut/impl/core/budget.hpp>
#include <taut/impl/map/parameterize.hpp>
#include <taut/impl/mesh/validate.hpp>

namespace taut::impl
{

/// Charts of a surface with their maps, each as flattened: the first phases of make_atlas().
class flat_charts
{
    friend class short_charts;

public:
    flat_charts(queue& q, const mesh<triangle>& m, const atlas_params& params)
        : queue_(q), mesh_(m), params_(params), facets_(facets(m)), budget_(params.limits.time_limit)
    {
    }

    void run()
    {
        wish_for_seams();
        if (params_.keep_charts)
            keep_charts();
        else if (params_.symmetric)
            mirror_charts();
        else if (params_.prefer == chart_preference::packing)
            make_charts();
        else
            cut_short();
        if (params_.stack && !params_.keep_charts && !params_.symmetric) copy_components();
        join_polygons();
    }

protected:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// Triangles of the surface in the plane, in its units, as in their charts.
    struct laid_triangles
    {
        std::vector<vec2> uv;       // one per corner
        std::vector<double> energy; // one per triangle: of its chart
    };

    /// Checks the limits, in a stage.
    observer asking(std::string_view stage)
    {
        return [this, stage](const progress& p)
        {
            const bool in_time = budget_.in_time();
            const auto& ask = params_.limits.observer;
            const bool wanted = !ask || ask({.iteration = p.iteration,
                                             .value = p.value,
                                             .gradient = std::numeric_limits<double>::quiet_NaN(),
                                             .seconds = budget_.total(),
                                             .stage = stage,
                                             .usable = usable_});
            report_.complete = report_.complete && in_time && wanted;
            return report_.complete;
        };
    }

    enum class precise
    {
        usual,
        exactly, ///< nearly to the limit of rounding, so that what can be flat is
        rough    ///< see flatten_tuning::rough
    };

    /// Maps all charts, in `steps` each at most.
    flattened_charts flatten(const chart_mesh& charts, std::span<const vec2> initial, int steps,
                             precise how = precise::usual)
    {
        flatten_params params;
        if (how == precise::exactly) params.tolerance = std::min(params.tolerance, 1e-9);
        params.tuning.rough = how == precise::rough;
        params.max_iterations = std::min(params.max_iterations, steps);
        params.initial = initial;
        params.limits = {std::max(budget_.left(), budget::seconds(1e-6)), asking("flatten")};
        const double begin = budget_.total();
        auto flat = flatten_charts(queue_, charts, params);
        report_.seconds.flatten += budget_.total() - begin;
        usable_ = true;
        return flat;
    }

    /// What seams count along each side, and what of the surface is seen.
    void wish_for_seams()
    {
        const seam_wishes& wishes = params_.wishes;
        wishes.validate(facets_.twin.size());
        if (!wishes.any() || params_.keep_charts) return;
        if (wishes.hide > 0) open_ = vertex_openness(mesh_);
        factors_ = seam_factors(mesh_, facets_, wishes, open_);
    }

    void make_charts()
    {
        usable_ = true; // whatever there is by the end of the time is laid as it is seen
        auto params = params_.charts;
        if (!factors_.empty()) params.weights = factors_;
        params.limits = {std::max(budget_.left(), budget::seconds(1e-6)), asking("charts")};
        // What takes more steps at first is mostly cut after all of them.
        constexpr int few = 25;
        const auto first_maps = [this](const chart_mesh& charts, std::span<const vec2> start)
        { return flatten(charts, start, start.empty() ? few : std::numeric_limits<int>::max()); };
        auto made = segment_surface(mesh_, facets_, maps_by(first_maps), params);
        report_.complete = report_.complete && budget_.in_time();
        seam_ = std::move(made.seam);
        laid_triangles laid{std::move(made.uv), std::move(made.energy)};
        if (report_.complete)
            cut(laid);
        else
            cut_unfinished(std::move(laid), made.crosses);
        report_.seconds.charts = budget_.lap() - report_.seconds.flatten;
        if (report_.complete) mend(unfit());
    }

    /// Charts along short seams (short_charts.hpp).
    void cut_short();

    /// The charts of a run that has ended; those without a good map are divided into cells.
    void cut_unfinished(laid_triangles laid, std::span<const char> crosses)
    {
        const double bound = params_.charts.max_distortion;
        const double most = std::max(cell_growing::kept, std::isfinite(bound) ? bound : 4.0);
        std::vector<char> wanted(laid.energy.size());
        for (std::size_t c = 0; c < wanted.size(); ++c) wanted[c] = crosses[c] != 0 || !(laid.energy[c] <= most);
        if (std::count(wanted.begin(), wanted.end(), char(1)) > 0)
            report_.notes.push_back("parts without a map by then became " + std::to_string(lay_at_once(laid, wanted)) +
                                    " charts, mapped at once");
        cut(laid);
    }

    /// Makes the charts of one half of the surface, and their mirror images.
    void mirror_charts()
    {
        mirror_ = find_symmetry(mesh_, facets_, params_.charts.together);
        const symmetric_half half(mesh_, facets_, *mirror_);
        std::vector<char> seams, together;
        atlas_params of_half = half.params(params_, seams, together);
        of_half.limits.time_limit = budget_.left();
        flat_charts one(queue_, half.surface(), of_half);
        one.report_.seconds = report_.seconds;
        one.run();
        report_ = std::move(one.report_);
        usable_ = true;
        seam_ = half.seams(one.seam_);
        const auto laid = one.triangles_as_laid();
        laid_triangles whole{std::vector<vec2>(facets_.twin.size()), std::vector<double>(mesh_.cells().size())};
        half.for_each_corner(
            [&](std::size_t corner, std::size_t own, bool mirrored)
            {
                whole.uv[corner] = mirrored ? vec2(-laid.uv[own].x, laid.uv[own].y) : laid.uv[own];
                whole.energy[corner / 3] = laid.energy[own / 3];
            });
        cut(whole);
        report_.seconds.charts = budget_.lap() - report_.seconds.flatten;
        mend(turned());
    }

    /// One flag per chart: 1 where a triangle is flipped, as may happen where polygons that are mirror images are cut
    /// along other diagonals.
    std::vector<char> turned() const
    {
        std::vector<char> bad(energy_.size(), 0);
        const auto& cells = charts_->surface.cells();
        for (std::size_t k = 0; k < bad.size(); ++k)
            for (auto c = u(charts_->first_cell[k]); c < u(charts_->first_cell[k + 1]) && !bad[k]; ++c)
                bad[k] = orient2d(flat_[u(cells[c][0])], flat_[u(cells[c][1])], flat_[u(cells[c][2])]) <= 0;
        return bad;
    }

    void keep_charts()
    {
        seam_.assign(params_.charts.seams.begin(), params_.charts.seams.end());
        seam_.resize(facets_.twin.size(), 0);
        charts_.emplace(cut_charts(mesh_, facets_, seam_));
        std::vector<vec2> initial(params_.initial.empty() ? 0 : charts_->surface.points().size());
        if (!initial.empty())
            for_each_corner([&](std::size_t cell, std::size_t corner, std::size_t v)
                            { initial[v] = params_.initial[cell][corner]; });
        if (!params_.relax && !initial.empty())
        {
            lay_as_given(std::move(initial));
            return;
        }
        auto flat = flatten(*charts_, initial, std::numeric_limits<int>::max());
        report_.seconds.charts = budget_.lap() - report_.seconds.flatten;
        for (const auto& chart : flat.charts) energy_.push_back(chart.energy);
        flat_ = std::move(flat.uv);
        mend(unfit());
    }

    /// Takes the maps of kept charts as they are, each with the area that its triangles have on the surface.
    void lay_as_given(std::vector<vec2> uv)
    {
        flat_ = std::move(uv);
        const ideal_elements<triangle> ideal(charts_->surface);
        const auto& cells = charts_->surface.cells();
        for (std::size_t k = 0; k < u(charts_->charts()); ++k)
        {
            double in_plane = 0, in_space = 0;
            for (auto c = u(charts_->first_cell[k]); c < u(charts_->first_cell[k + 1]); ++c)
            {
                in_plane += orient(flat_[u(cells[c][0])], flat_[u(cells[c][1])], flat_[u(cells[c][2])]).det / 2;
                in_space += ideal.measure[c];
            }
            const double scale = in_plane != 0 ? std::sqrt(in_space / std::abs(in_plane)) : 1;
            for (auto v = u(charts_->first_vertex[k]); v < u(charts_->first_vertex[k + 1]); ++v)
                flat_[v] *= vec2(in_plane < 0 ? -scale : scale, scale);
            energy_.push_back(area_and_energy(*charts_, k, flat_, ideal).second);
        }
        usable_ = true;
        report_.seconds.charts = budget_.lap();
        const auto bad = unfit();
        const auto k = static_cast<std::size_t>(std::find(bad.begin(), bad.end(), char(1)) - bad.begin());
        if (k < bad.size())
            report_.reason =
                report_.name_chart(charts_->cell_origins[u(charts_->first_cell[k])]) +
                " is folded, or overlaps itself, as it is given; relax it (--charts keep), or let charts be made";
    }

    /// Calls f(triangle of the surface, corner, vertex of the charts) for all corners.
    template <class F>
    void for_each_corner(F&& f) const
    {
        for (std::size_t i = 0; i < charts_->cell_origins.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) f(u(charts_->cell_origins[i]), k, u(charts_->surface.cells()[i][k]));
    }

    /// One flag per chart: 1 where it has no map, or overlaps itself.
    std::vector<char> unfit() const
    {
        auto bad = crossing_charts(*charts_, flat_);
        for (std::size_t k = 0; k < bad.size(); ++k)
            bad[k] = bad[k] != 0 || !(energy_[k] < std::numeric_limits<double>::infinity());
        return bad;
    }

    /// Removes the crossings of the borders of these charts, and divides those for which that fails.
    void mend(std::vector<char> bad)
    {
        keep_apart(bad);
        if (!params_.keep_charts && report_.complete) bad = part_overlaps(std::move(bad));
        if (std::count(bad.begin(), bad.end(), char(1)) > 0) take_apart(bad, 0);
    }

    /// Parts these charts, one flag each, where they lie on themselves. Returns the flags of those that are unfit then.
    std::vector<char> part_overlaps(std::vector<char> bad);

    /// Maps these charts anew with borders kept apart. Clears the flags where that succeeds.
    /// roughly: in 100 steps, and not the large ones, each step of which costs what few cuts save
    void keep_apart(std::vector<char>& bad, bool roughly = false);

    /// Divides these charts, unless they are to be kept: into planar-projection patches of so many triangles at most,
    /// or, where that is 0, into cells.
    void take_apart(const std::vector<char>& bad, std::size_t largest)
    {
        if (!report_.reason.empty()) return;
        const auto first_bad = static_cast<std::size_t>(std::find(bad.begin(), bad.end(), char(1)) - bad.begin());
        if (params_.keep_charts)
        {
            report_.reason = report_.name_chart(charts_->cell_origins[u(charts_->first_cell[first_bad])]) +
                             " has no map, or none without overlaps, and cannot be kept; let charts be made";
            return;
        }
        std::vector<char> wanted(mesh_.cells().size(), 0);
        for (std::size_t k = 0; k < bad.size(); ++k)
            for (auto i = u(charts_->first_cell[k]); i < u(charts_->first_cell[k + 1]); ++i)
                wanted[u(charts_->cell_origins[i])] = bad[k];
        auto laid = triangles_as_laid();
        const auto made = largest > 0
                              ? take_patches(laid, lay_as_seen(mesh_, facets_, wanted, params_.charts.seams, largest))
                              : lay_at_once(laid, wanted);
        cut(laid);
        const auto count = std::count(bad.begin(), bad.end(), char(1));
        report_.notes.push_back(std::to_string(count) + (count == 1 ? " chart" : " charts") + " without a map became " +
                                std::to_string(made) + (largest > 0 ? ", laid as they are seen" : ", mapped at once"));
    }

    /// Takes patches as charts. Returns their number.
    std::size_t take_patches(laid_triangles& laid, const seen_patches& seen);

    /// Divides these triangles, one flag each, into planar-projection patches, or into cells where the surface is too
    /// rough for that. Returns the number of charts.
    std::size_t lay_at_once(laid_triangles& laid, std::span<const char> wanted);

    /// Divides these triangles, one flag each, into cells, and maps these at once. Returns the number of cells.
    std::size_t lay_cells(laid_triangles& laid, std::span<const char> wanted);

    /// Takes steps with the maps of cells, for a tenth of the time so far, and parts those that lie on themselves then.
    void relax_cells(laid_triangles& laid, std::span<const char> wanted);

    /// Triangles of the surface as mapped in the charts.
    laid_triangles triangles_as_laid() const
    {
        laid_triangles laid{std::vector<vec2>(facets_.twin.size()), std::vector<double>(mesh_.cells().size())};
        for (std::size_t k = 0; k < energy_.size(); ++k)
            for (auto i = u(charts_->first_cell[k]); i < u(charts_->first_cell[k + 1]); ++i)
                laid.energy[u(charts_->cell_origins[i])] = energy_[k];
        for_each_corner([&](std::size_t cell, std::size_t corner, std::size_t v)
                        { laid.uv[3 * cell + corner] = flat_[v]; });
        return laid;
    }

    /// Replaces the maps of some triangles, with seams around them. label(triangle): its new chart, -1 if unchanged;
    /// energy_of(label), uv_of(triangle, corner): of the new ones
    template <class Label, class Energy, class Map>
    void lay_anew(laid_triangles& laid, Label&& label, Energy&& energy_of, Map&& uv_of)
    {
        parallel_for(mesh_.cells().size(),
                     [&](std::size_t begin, std::size_t end)
                     {
                         for (std::size_t c = begin; c < end; ++c)
                         {
                             const idx own = label(c);
                             if (own >= 0) laid.energy[c] = energy_of(own);
                             for (std::size_t s = 3 * c; s < 3 * c + 3; ++s)
                             {
                                 if (own >= 0) laid.uv[s] = uv_of(c, s % 3);
                                 if (facets_.twin[s] < 0) continue;
                                 const idx other = label(u(facets_.twin[s]) / 3);
                                 const bool given = !params_.charts.seams.empty() && params_.charts.seams[s] != 0;
                                 if (own >= 0 || other >= 0) seam_[s] = given || own != other;
                             }
                         }
                     });
    }

    /// Cuts the surface along its seams.
    void cut(const laid_triangles& laid)
    {
        charts_.emplace(cut_charts(mesh_, facets_, seam_));
        flat_.resize(charts_->surface.points().size());
        for_each_corner([&](std::size_t cell, std::size_t corner, std::size_t v)
                        { flat_[v] = laid.uv[3 * cell + corner]; });
        energy_.clear();
        for (std::size_t k = 0; k + 1 < charts_->first_cell.size(); ++k)
            energy_.push_back(laid.energy[u(charts_->cell_origins[u(charts_->first_cell[k])])]);
    }

    /// Cuts components that are copies of each other in space as the least distorted of them is cut, with its maps.
    void copy_components()
    {
        if (!report_.reason.empty()) return;
        const chart_mesh whole = cut_charts(mesh_, facets_, std::vector<char>(seam_.size(), 0));
        const stacked_charts copies(whole, {});
        if (copies.leaders().size() == copies.leader().size()) return;
        const auto own = [&](idx side) { return 3 * u(whole.cell_origins[u(side / 3)]) + u(side % 3); };
        auto laid = triangles_as_laid();
        const auto seam = seam_;
        std::vector<double> energy; // of each component, summed over its triangles
        for (idx k = 0; k < whole.charts(); ++k)
        {
            energy.push_back(0);
            for (auto c = u(whole.first_cell[u(k)]); c < u(whole.first_cell[u(k) + 1]); ++c)
                energy.back() += laid.energy[u(whole.cell_origins[c])];
        }
        const auto best = copies.best(energy);
        std::vector<idx> model(seam.size()); // of each side of a first copy, that of the best one
        for (idx k = 0; k < whole.charts(); ++k)
            if (best[u(copies.leader()[u(k)])] == k)
                for (idx s = 3 * whole.first_cell[u(k)]; s < 3 * whole.first_cell[u(k) + 1]; ++s)
                    model[u(copies.sides()[u(s)])] = s;
        for (idx s = 0; s < static_cast<idx>(seam.size()); ++s)
        {
            const idx first = model[u(copies.sides()[u(s)])];
            if (first == s) continue;
            const bool given = !params_.charts.seams.empty() && params_.charts.seams[own(s)] != 0;
            seam_[own(s)] = seam[own(first)] != 0 || given;
            laid.uv[own(s)] = laid.uv[own(first)]; // a side and a corner have one number
            laid.energy[own(s) / 3] = laid.energy[own(first) / 3];
        }
        cut(laid);
    }

    /// Makes polygons that are divided by seams charts of their own.
    void join_polygons()
    {
        const auto& together = params_.charts.together;
        if (together.empty() || params_.keep_charts || !report_.reason.empty()) return;
        const auto polygon = polygons_of(facets_, together);
        std::vector<char> parted(mesh_.cells().size(), 0);
        for (std::size_t s = 0; s < together.size(); ++s)
            if (together[s] != 0 && facets_.twin[s] >= 0 && seam_[s] != 0) parted[u(polygon[s / 3])] = 1;
        if (std::count(parted.begin(), parted.end(), char(1)) == 0) return;
        const auto label = [&](std::size_t c)
        {
            const idx p = polygon[c];
            return parted[u(p)] ? p : -1;
        };
        auto laid = triangles_as_laid();
        lay_anew(
            laid, label, [](idx) { return std::numeric_limits<double>::infinity(); },
            [](std::size_t, std::size_t) { return vec2(0.0); });
        std::vector<idx> triangles, number(mesh_.points().size(), -1);
        for (std::size_t c = 0; c < parted.size(); ++c)
            if (label(c) >= 0) triangles.push_back(static_cast<idx>(c));
        const surface_part part = part_of(mesh_, triangles, seam_, number);
        flatten_params few;
        few.max_iterations = report_.complete ? few.max_iterations : 0; // their starts are made at once
        auto maps = flatten_charts(queue_, part.charts, few);
        const ideal_elements<triangle> ideal(part.charts.surface);
        for (idx k = 0; k < part.charts.charts(); ++k)
        {
            double& energy = maps.charts[u(k)].energy;
            if (energy < std::numeric_limits<double>::infinity() && !overlaps_itself(part.charts, u(k), maps.uv))
                continue;
            lay_round(part.charts, u(k), maps.uv);
            energy = area_and_energy(part.charts, u(k), maps.uv, ideal).second;
        }
        for (idx k = 0; k < part.charts.charts(); ++k)
            for (auto i = u(part.charts.first_cell[u(k)]); i < u(part.charts.first_cell[u(k) + 1]); ++i)
            {
                const auto c = u(part.triangles[i]);
                laid.energy[c] = maps.charts[u(k)].energy;
                for (std::size_t j = 0; j < 3; ++j) laid.uv[3 * c + j] = maps.uv[u(part.charts.surface.cells()[i][j])];
            }
        cut(laid);
        report_.notes.push_back("polygons that were in several charts became charts by themselves");
        mend(unfit());
    }

    queue& queue_;
    const mesh<triangle>& mesh_;
    const atlas_params& params_;
    facet_table facets_;
    budget budget_;
    atlas_report report_;
    std::optional<mirror_symmetry> mirror_;
    std::vector<char> seam_;             // one per side of the surface
    std::vector<double> factors_, open_; // what seams count, one per side; what is seen, one per vertex; or empty
    std::optional<chart_mesh> charts_;
    std::vector<vec2> flat_;     // one per vertex of the charts, in units of the surface
    std::vector<double> energy_; // one per chart
    bool usable_ = false;
};

} // namespace taut::impl
