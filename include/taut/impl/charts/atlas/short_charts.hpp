// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/cutting/mend_charts.hpp>
#include <taut/impl/charts/atlas/cutting/sew_tips.hpp>
#include <taut/impl/charts/atlas/cutting/short_cutting.hpp>
#include <taut/impl/charts/atlas/pressed_charts.hpp>
#include <taut/impl/charts/atlas/seams/straighten.hpp>
#include <taut/impl/charts/atlas/segment.hpp>
#include <taut/impl/charts/atlas/settled_charts.hpp>

namespace taut::impl
{

/// A surface cut along short seams, and flattened.
struct short_trial
{
    chart_set set;
    std::vector<char> bad;   ///< charts without a map, or that overlap themselves
    std::vector<char> plain; ///< charts that had a map that did not from the beginning
    double length = 0;       ///< price of the seams
    double mean = 0;         ///< energy
    bool holds = false;      ///< the bound, and the charts are fit

    bool better_than(const short_trial& other) const
    {
        if (holds != other.holds) return holds;
        return holds ? length < other.length : mean < other.mean;
    }
};

inline double chart_area(const chart_mesh& charts, std::size_t k)
{
    return area_of(charts.surface, charts.first_cell[k], charts.first_cell[k + 1]);
}

/// Area mean over all charts.
inline double mean_energy(const chart_set& set)
{
    double sum = 0, area = 0;
    for (std::size_t k = 0; k < set.energy.size(); ++k)
    {
        const double own = chart_area(set.charts, k);
        sum += own * set.energy[k];
        area += own;
    }
    return sum / area;
}

/// One flag a chart: 1 where its border meets itself once coordinates are rounded. Plain shapes have borders that touch
/// themselves exactly. Where rounding flattens triangles, they are what lies between: needles, whose sides nothing
/// keeps apart.
inline std::vector<char> touching_charts(const chart_set& set)
{
    constexpr double digits = 1 << 22;
    std::vector<vec2> rounded = set.uv;
    double size = 0;
    for (const vec2& p : rounded) size = std::max({size, std::abs(p.x), std::abs(p.y)});
    const double unit = size > 0 && size < std::numeric_limits<double>::infinity() ? size / digits : 1;
    for (vec2& p : rounded) p = unit * vec2(std::round(p.x / unit), std::round(p.y / unit));
    auto touching = crossing_charts(set.charts, rounded);
    for (std::size_t k = 0; k < touching.size(); ++k)
        touching[k] = touching[k] && turned_triangle(set.charts, k, rounded) < 0;
    return touching;
}

/// Straightens seams, cuts the surface along them, and flattens it.
inline short_trial try_seams(atlas_run& run, const atlas_surface& of, std::vector<char> seam,
                             const short_cutting& cutting, budget& limits)
{
    const auto prices = cutting.prices();
    straighten(of.surface, of.facets, seam, cutting.settled(), of.params.charts.together, limits, prices,
               {.distance = 0.03 * std::sqrt(cutting.area()), .least_length = 0.8});
    // Of a rough surface the bound is out of reach, and the last digits take most of the steps.
    const auto how = cutting.rough() ? atlas_run::precise::rough : atlas_run::precise::exactly;
    short_trial made{.set =
                         cut(of, {std::move(seam), cutting.places(), std::vector<double>(of.surface.cells().size())}),
                     .bad = {},
                     .plain = {}};
    flatten(run, made.set, how);
    made.bad = unfit(made.set);
    const auto touching = touching_charts(made.set);
    for (std::size_t k = 0; k < touching.size(); ++k)
    {
        made.bad[k] = made.bad[k] || touching[k];
        made.plain.push_back(made.bad[k] == 0);
    }
    for (std::size_t s = 0; s < prices.size(); ++s) // each edge once
        if (made.set.seam[s] && of.facets.twin[s] > static_cast<idx>(s)) made.length += prices[s];
    made.mean = mean_energy(made.set);
    return made;
}

/// Has segment() cut some triangles, one flag each. Adds its seams.
inline void segment_rest(atlas_run& run, const atlas_surface& of, std::span<const char> wanted, std::vector<char>& seam)
{
    if (std::count(wanted.begin(), wanted.end(), char(0)) == static_cast<std::ptrdiff_t>(wanted.size())) return;
    const surface_part part = part_of(of.surface, wanted, seam);
    const auto f = facets(part.charts.surface);
    const auto together = part.by_side(of.params.charts.together);
    const auto factors = part.by_side(std::span<const double>(of.factors));
    auto params = of.params.charts;
    params.seams = {};
    params.together = together;
    params.weights = factors;
    params.tuning.least_fill = 0;
    params.tuning.unite_rounds = std::max(params.tuning.unite_rounds, 6); // few charts, whatever they are like
    params.max_distortion = std::min(params.max_distortion, std::max(4.2, params.mean_distortion));
    // Of large charts that are cut anyway, and of those that many steps would bring no further.
    const auto maps = [&run](const chart_mesh& charts, std::span<const vec2> start)
    { return run.flatten(charts, start, start.empty() ? atlas_run::precise::rough : atlas_run::precise::usual); };
    const auto made = segment_surface(part.charts.surface, f, maps_by(maps), params, run.limits("charts"));
    for (std::size_t s = 0; s < made.laid.seam.size(); ++s)
        if (made.laid.seam[s]) seam[part.origin(s)] = 1;
}

/// The bound of the mean energy that a search keeps: less what rounding and scale take, and this part of what is
/// allowed.
inline double bound_of_search(const atlas_surface& of, double less = 0)
{
    return 4 + (0.998 - less) * (of.params.charts.mean_distortion - 4);
}

/// Whether charts are bent and cut so that they fill squares.
inline bool fills_squares(const atlas_params& params)
{
    const auto& packing = params.packing;
    return params.prefer == chart_preference::seams && !params.symmetric && !params.stack && packing.walls.empty() &&
           !packing.on_grid() && packing.tiles == 1;
}

/// The packing of charts that are tried: what is given by triangle is left out.
inline pack_params packing_of_square(const atlas_params& params)
{
    pack_params packing = params.packing;
    packing.groups.clear();
    packing.densities.clear();
    return packing;
}

/// Sews up some charts, one flag each, until the bound of the mean of all is reached. whole: their maps may follow as a
/// whole, which does not keep borders apart
inline void sew_up(const atlas_surface& of, chart_set& set, const std::vector<char>& wanted, bool whole, double mean,
                   budget& limits)
{
    const auto flags = by_triangle(set.charts, wanted);
    double others = 0, own = 0; // energy, area
    for (std::size_t k = 0; k < wanted.size(); ++k)
    {
        const double area = chart_area(set.charts, k);
        wanted[k] ? own += area : others += area * set.energy[k];
    }
    std::vector<idx> some;
    for (std::size_t c = 0; c < flags.size(); ++c)
        if (flags[c]) some.push_back(static_cast<idx>(c));
    if (some.empty()) return;
    double all = own;
    for (std::size_t k = 0; k < wanted.size(); ++k) all += wanted[k] ? 0 : chart_area(set.charts, k);
    const double bound = (mean * all - others) / own;
    auto flat = laid(set);
    if (!sew_laid(
            of.surface, {flat.seam, flat.uv, some, whole}, of.params.charts.seams, bound,
            [&limits] { return limits.proceed(); }, of.factors))
        return;
    set = cut(of, std::move(flat));
    measure(set);
}

/// Cuts a surface along short seams until the bound of distortion holds on the surface itself: what they leave is
/// flattened, and they are sewn up or opened.
class short_search
{
public:
    /// rest: seams of what `cutting` found none for, one flag a side. Refers to all.
    short_search(atlas_run& run, const atlas_surface& of, short_cutting& cutting, std::span<const char> rest,
                 budget& limits)
        : run_(run), of_(of), cutting_(cutting), rest_(rest), limits_(limits)
    {
    }

    /// Finds the best trial, beginning with these seams. Not for a run that has ended.
    short_trial best(std::vector<char> seam)
    {
        constexpr int turns = 8;
        for (int turn = 0; turn < turns && run_.report.complete; ++turn)
        {
            short_trial now = try_seams(run_, of_, seam, cutting_, limits_);
            needles_ = cutting_.rough();
            if (!run_.report.complete && best_) break;
            const double flattened = now.mean;
            const auto crossing = std::count(now.bad.begin(), now.bad.end(), char(1));
            const double excess = keep_borders_apart(now, crossing > 0);
            rough_ = is_rough(flattened - bound_, turn);
            if (rough_ && flattened < std::numeric_limits<double>::infinity() && !(best_ && best_->holds))
                return turn == 0 ? now : *first_;
            const double mean = now.mean;
            const bool holds = now.holds;
            if (turn == 0 && !holds) first_ = now;
            if (!best_ || now.better_than(*best_)) best_ = std::move(now);
            if (holds && (large_ || turn > 1 || mean > bound_ - 0.2 * allowed_)) break;
            if (!(mean < std::numeric_limits<double>::infinity())) break;
            // Ever more cautious, so that it holds in the end.
            const double more = holds ? 0.8 * (bound_ - mean) : -excess - 0.03 * (1 + turn) * allowed_;
            asked_ -= more;
            cutting_.adjust(more,
                            missed_ > 2 || (missed_ > 1 && excess > 0.2 * allowed_) || (crossing > 0 && turn > 4));
            auto next = cutting_.seams();
            for (std::size_t s = 0; s < next.size(); ++s) next[s] = next[s] || rest_[s];
            if (holds && next == seam) break; // nothing can be sewn up
            seam = std::move(next);
        }
        lies_on_itself_ = !best_->holds && !rough_ && loose_;
        return std::move(lies_on_itself_ ? *loose_ : *best_);
    }

    bool rough() const { return rough_; }     ///< noise costs what no seam saves
    bool needles() const { return needles_; } ///< see short_cutting::rough(), of the last trial
    /// Whether the best trial is within the bound only where charts may lie on themselves.
    bool lies_on_itself() const { return lies_on_itself_; }

private:
    /// Maps charts with borders kept apart where that may be within the bound. Returns by how much the mean energy is
    /// above it then.
    double keep_borders_apart(short_trial& now, bool crosses)
    {
        const double flattened = now.mean, overlap = crosses ? cutting_.overlap() : 0;
        double excess = now.mean + rate_ * overlap - bound_;
        if (!loose_ && flattened <= bound_) loose_ = now;
        if (excess <= 0 && crosses)
        {
            keep_apart(run_, now.set, now.bad);
            now.mean = mean_energy(now.set);
            excess = now.mean - bound_;
            rate_ = std::clamp((now.mean - flattened) / std::max(overlap, 0.01), 0.1, 2.0);
            missed_ += excess > 0;
        }
        now.holds = now.mean <= bound_ && excess <= 0;
        return excess;
    }

    /// Noise on a surface costs what no seam saves: then they stay as they are for what is large.
    /// above: what the mean energy is above the bound
    bool is_rough(double above, int turn)
    {
        if (turn == 0) first_above_ = above;
        return cutting_.rough() || above > 1.5 * allowed_ ||
               (turn > 1 && above > 0.5 * allowed_ && above > first_above_ - 0.3 * asked_);
    }

    atlas_run& run_;
    const atlas_surface& of_;
    short_cutting& cutting_;
    std::span<const char> rest_;
    budget& limits_;
    double bound_ = bound_of_search(of_), allowed_ = bound_ - 4;
    // One more map costs more than what it may save.
    bool large_ = of_.surface.cells().size() > 30'000 || cutting_.pieces() > 64;
    double rate_ = 0.4; // mean energy that it costs to keep borders apart, about, by the part that overlaps
    int missed_ = 0;    // maps with their borders kept apart that were above the bound
    double first_above_ = 0, asked_ = 0; // excess of the first turn, what it was to become less since
    bool rough_ = false, needles_ = false, lies_on_itself_ = false;
    std::optional<short_trial> best_, first_, loose_; // loose: within the bound where charts may lie on themselves
};

/// Has segment() cut the charts, one flag each, that have no map, overlap themselves or are above the bound.
inline void cut_rest(atlas_run& run, const atlas_surface& of, chart_set& set, const std::vector<char>& bad)
{
    auto flat = laid(set);
    const auto wanted = by_triangle(set.charts, bad);
    segment_rest(run, of, wanted, flat.seam);
    if (!run.report.complete) return;
    const surface_part part = part_of(of.surface, wanted, flat.seam);
    const auto maps = run.flatten(part.charts);
    for (std::size_t k = 0; k < maps.charts.size(); ++k) part.write(k, maps.charts[k].energy, maps.uv, flat);
    set = cut(of, std::move(flat));
    if (run.report.complete) mend(run, of, set, unfit(set));
}

/// Of a run that has ended: what has no good map becomes patches.
inline chart_set unfinished(atlas_run& run, const atlas_surface& of, const chart_set& set)
{
    return cut_unfinished(run, of, laid(set), by_triangle(set.charts, unfit(set)));
}

/// Sews up the charts of a search where that is within the bound, and cuts those further that are not fit.
inline chart_set finished(atlas_run& run, const atlas_surface& of, const short_search& search, short_trial best,
                          bool few, budget& limits)
{
    chart_set& set = best.set;
    atlas_report& report = run.report;
    if (report.complete && best.holds && few)
    {
        // What charts that are to be bent need of it, so that the square is used more.
        constexpr double bending = 0.04;
        const bool presses = fills_squares(of.params) &&
                             chart_press(run, set, packing_of_square(of.params), bound_of_search(of)).leader() >= 0;
        const double bound = bound_of_search(of, presses ? bending : 0);
        sew_up(of, set, best.plain, true, bound, limits);
        if (std::count(best.plain.begin(), best.plain.end(), char(0)) > 0 && report.complete)
            sew_up(of, set, std::vector<char>(set.energy.size(), 1), false, bound, limits);
    }
    if (!report.complete) return unfinished(run, of, set);
    const bool part = search.lies_on_itself();
    if (!part && !best.holds) keep_apart(run, set, best.bad, search.needles());
    if (part || search.needles()) best.bad = part_overlaps(of, set, std::move(best.bad));
    if (!best.holds && !search.rough() && !part) best.bad.assign(best.bad.size(), 1);
    best.bad.resize(set.energy.size(), 0);
    for (std::size_t k = 0; k < set.energy.size(); ++k)
        if (!(set.energy[k] <= of.params.charts.max_distortion)) best.bad[k] = 1;
    if (std::count(best.bad.begin(), best.bad.end(), char(1)) > 0) cut_rest(run, of, set, best.bad);
    if (!report.complete) return unfinished(run, of, set);
    if (const double mean = mean_energy(set); mean > of.params.charts.mean_distortion)
    {
        char text[200];
        std::snprintf(text, sizeof text,
                      "the mean energy is %.4g where %.4g is wanted, which short seams do not reach%s; more charts do "
                      "(--prefer packing)",
                      mean, of.params.charts.mean_distortion, search.rough() ? " on a rough surface" : "");
        report.notes.emplace_back(text);
    }
    return std::move(set);
}

/// Charts along short seams.
inline chart_set short_charts(atlas_run& run, const atlas_surface& of)
{
    of.params.charts.validate();
    run.usable = true;
    const run_limits left = run.limits("charts");
    budget limits(left.time_limit, left.observer);
    short_cutting cutting(of.surface, of.facets,
                          {.bound = of.params.charts.mean_distortion,
                           .seams = of.params.charts.seams,
                           .together = of.params.charts.together,
                           .factors = of.factors,
                           .part = of.params.prefer == chart_preference::seams},
                          limits);
    cutting.run();
    const auto found = cutting.seams();
    auto seam = found;
    if (run.goes_on()) segment_rest(run, of, cutting.unfound(), seam);
    if (!run.goes_on())
    {
        const std::size_t cells = of.surface.cells().size();
        return cut_unfinished(run, of,
                              {std::move(seam), std::vector<vec2>(3 * cells),
                               std::vector<double>(cells, std::numeric_limits<double>::infinity())},
                              std::vector<char>(cells, 1));
    }
    auto rest = seam;
    for (std::size_t s = 0; s < rest.size(); ++s) rest[s] = rest[s] && !found[s];
    short_search search(run, of, cutting, rest, limits);
    auto best = search.best(std::move(seam));
    return finished(run, of, search, std::move(best), cutting.pieces() <= 64, limits);
}

} // namespace taut::impl
