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

#include <taut/impl/atlas/cutting/keep_apart.hpp>
#include <taut/impl/atlas/cutting/laid_cells.hpp>
#include <taut/impl/atlas/cutting/sew_tips.hpp>
#include <taut/impl/atlas/cutting/short_cutting.hpp>
#include <taut/impl/atlas/flat_charts.hpp>
#include <taut/impl/atlas/seams/straighten.hpp>
#include <taut/impl/atlas/settled_charts.hpp>

namespace taut::impl
{

/// Makes charts along short seams for flat_charts: looks for these, flattens what they leave, and sews them up or opens
/// them until the bound of distortion holds on the surface itself.
class short_charts
{
public:
    explicit short_charts(flat_charts& charts) : c_(charts) {}

    void run()
    {
        c_.params_.charts.validate();
        c_.usable_ = true;
        budget limits(std::max(c_.budget_.left(), budget::seconds(1e-6)), c_.asking("charts"));
        short_cutting cutting(c_.mesh_, c_.facets_,
                              {.bound = c_.params_.charts.mean_distortion,
                               .seams = c_.params_.charts.seams,
                               .together = c_.params_.charts.together,
                               .factors = c_.factors_,
                               .part = c_.params_.prefer == chart_preference::seams},
                              limits);
        cutting.run();
        const auto found = c_.seam_ = cutting.seams();
        c_.report_.complete = c_.report_.complete && c_.budget_.in_time() && !limits.over();
        if (c_.report_.complete) segment_rest(cutting.unfound());
        rest_ = c_.seam_;
        for (std::size_t s = 0; s < rest_.size(); ++s) rest_[s] = rest_[s] && !found[s];
        c_.report_.complete = c_.report_.complete && c_.budget_.in_time();
        if (!c_.report_.complete)
        {
            c_.cut_unfinished({std::vector<vec2>(c_.facets_.twin.size()),
                               std::vector<double>(c_.mesh_.cells().size(), std::numeric_limits<double>::infinity())},
                              std::vector<char>(c_.mesh_.cells().size(), 1));
            return;
        }
        flatten_within_bound(cutting, limits);
        c_.report_.seconds.charts = c_.budget_.lap() - c_.report_.seconds.flatten;
    }

private:
    using laid_triangles = flat_charts::laid_triangles;
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// Flattens the charts of short seams. What they have of distortion is found out only then, and seams are sewn up
    /// or opened again until the bound holds.
    void flatten_within_bound(short_cutting& cutting, budget& limits)
    {
        const double allowed = 0.998 * (c_.params_.charts.mean_distortion - 4), bound = 4 + allowed; // rounding, scale
        // One more map costs more than what it may save.
        const bool large = c_.mesh_.cells().size() > 30'000 || cutting.pieces() > 64;
        constexpr int turns = 8;
        double rate = 0.4; // mean energy that it costs to keep borders apart, about, by the part that overlaps
        int missed = 0;    // maps with their borders kept apart that were above the bound
        double first_above = 0, asked = 0; // excess of the first turn, what it was to become less since
        bool rough = false;
        std::optional<laid_charts> best, first, loose; // loose: within the bound where charts may lie on themselves
        std::vector<char> cut_before = c_.seam_;
        for (int turn = 0; turn < turns && c_.report_.complete; ++turn)
        {
            laid_charts now = lay_short(cutting, limits);
            if (!c_.report_.complete && best) break;
            for (const char bad : now.bad) now.plain.push_back(bad == 0);
            const auto crossing = std::count(now.bad.begin(), now.bad.end(), char(1));
            const double flattened = now.mean;
            const double overlap = crossing > 0 ? cutting.overlap() : 0;
            double excess = now.mean + rate * overlap - bound;
            if (!loose && flattened <= bound) loose = now;
            if (excess <= 0 && crossing > 0)
            {
                c_.keep_apart(now.bad);
                now.energy = c_.energy_;
                now.flat = c_.flat_;
                now.mean = mean_energy();
                excess = now.mean - bound;
                rate = std::clamp((now.mean - flattened) / std::max(overlap, 0.01), 0.1, 2.0);
                missed += excess > 0;
            }
            now.holds = now.mean <= bound && excess <= 0;
            const double mean = now.mean;
            const bool holds = now.holds;
            // Noise on a surface costs what no seam saves: then they stay as they are for what is large.
            const double above = flattened - bound;
            if (turn == 0) first_above = above;
            rough = cutting.rough() || above > 1.5 * allowed ||
                    (turn > 1 && above > 0.5 * allowed && above > first_above - 0.3 * asked);
            if (rough && flattened < std::numeric_limits<double>::infinity() && !(best && best->holds))
            {
                if (turn == 0)
                    best = std::move(now);
                else
                    best = std::move(*first);
                break;
            }
            if (turn == 0 && !holds) first = now;
            if (!best || now.better_than(*best)) best = std::move(now);
            if (holds && (large || turn > 1 || mean > bound - 0.2 * allowed)) break;
            if (!(mean < std::numeric_limits<double>::infinity())) break;
            // Ever more cautious, so that it holds in the end.
            const double more = holds ? 0.8 * (bound - mean) : -excess - 0.03 * (1 + turn) * allowed;
            asked -= more;
            cutting.adjust(more, missed > 2 || (missed > 1 && excess > 0.2 * allowed) || (crossing > 0 && turn > 4));
            auto seams = cutting.seams();
            for (std::size_t s = 0; s < seams.size(); ++s) seams[s] = seams[s] || rest_[s];
            if (holds && seams == cut_before) break; // nothing can be sewn up
            c_.seam_ = cut_before = std::move(seams);
        }
        const bool part = !best->holds && !rough && loose;
        if (part) best = std::move(*loose);
        c_.seam_ = std::move(best->seam);
        c_.charts_.emplace(std::move(best->charts));
        c_.flat_ = std::move(best->flat);
        c_.energy_ = std::move(best->energy);
        if (c_.report_.complete && best->holds && cutting.pieces() <= 64)
        {
            sew_up(best->plain, true, limits);
            if (std::count(best->plain.begin(), best->plain.end(), char(0)) > 0 && c_.report_.complete)
                sew_up(std::vector<char>(c_.energy_.size(), 1), false, limits);
        }
        if (!c_.report_.complete) return lay_unfinished();
        if (!part && !best->holds) c_.keep_apart(best->bad, rough_);
        if (part || rough_) best->bad = c_.part_overlaps(std::move(best->bad));
        if (!best->holds && !rough && !part) best->bad.assign(best->bad.size(), 1);
        best->bad.resize(c_.energy_.size(), 0);
        for (std::size_t k = 0; k < c_.energy_.size(); ++k)
            if (!(c_.energy_[k] <= c_.params_.charts.max_distortion)) best->bad[k] = 1;
        if (std::count(best->bad.begin(), best->bad.end(), char(1)) > 0) mend_rest(best->bad);
        if (!c_.report_.complete) lay_unfinished();
        if (const double mean = mean_energy(); c_.report_.complete && mean > c_.params_.charts.mean_distortion)
            c_.report_.notes.push_back(note_above(mean, rough));
    }

    /// Of a run that has ended: what has no good map becomes patches.
    void lay_unfinished()
    {
        const auto bad = c_.unfit();
        std::vector<char> crosses(c_.mesh_.cells().size(), 0);
        for (std::size_t k = 0; k < bad.size(); ++k)
            for (auto i = u(c_.charts_->first_cell[k]); i < u(c_.charts_->first_cell[k + 1]); ++i)
                crosses[u(c_.charts_->cell_origins[i])] = bad[k];
        c_.cut_unfinished(c_.triangles_as_laid(), crosses);
    }

    std::string note_above(double mean, bool rough) const
    {
        char text[200];
        std::snprintf(text, sizeof text,
                      "the mean energy is %.4g where %.4g is wanted, which short seams do not reach%s; more charts do "
                      "(--prefer packing)",
                      mean, c_.params_.charts.mean_distortion, rough ? " on a rough surface" : "");
        return text;
    }

    /// A surface cut and flattened.
    struct laid_charts
    {
        std::vector<char> seam;
        chart_mesh charts;
        std::vector<vec2> flat;
        std::vector<double> energy;
        std::vector<char> bad;   // charts without a map, or that overlap themselves
        std::vector<char> plain; // charts that had a map that did not from the beginning
        double length, mean;
        bool holds; // the bound, and the charts are fit

        bool better_than(const laid_charts& other) const
        {
            if (holds != other.holds) return holds;
            return holds ? length < other.length : mean < other.mean;
        }
    };

    /// Cuts the surface along its seams, straightened, and flattens it.
    laid_charts lay_short(const short_cutting& cutting, budget& limits)
    {
        const auto prices = cutting.prices();
        straighten(c_.mesh_, c_.facets_, c_.seam_, cutting.settled(), c_.params_.charts.together, limits, prices,
                   {.distance = 0.03 * std::sqrt(cutting.area()), .least_length = 0.8});
        c_.charts_.emplace(cut_charts(c_.mesh_, c_.facets_, c_.seam_));
        // Of a rough surface the bound is out of reach, and the last digits take most of the steps.
        rough_ = cutting.rough();
        auto flat = c_.flatten(*c_.charts_, {}, std::numeric_limits<int>::max(),
                               rough_ ? flat_charts::precise::rough : flat_charts::precise::exactly);
        c_.energy_.clear();
        for (const auto& chart : flat.charts) c_.energy_.push_back(chart.energy);
        c_.flat_ = std::move(flat.uv);
        auto bad = c_.unfit();
        const auto touching = touching_charts();
        for (std::size_t k = 0; k < bad.size(); ++k) bad[k] = bad[k] || touching[k];
        return {c_.seam_,      *c_.charts_, c_.flat_, c_.energy_, std::move(bad), {}, price_of_seams(prices),
                mean_energy(), false};
    }

    /// One flag a chart: 1 where its border meets itself once coordinates are rounded. Plain shapes have borders that
    /// touch themselves exactly. Where rounding flattens triangles, they are what lies between: needles, whose sides
    /// nothing keeps apart.
    std::vector<char> touching_charts() const
    {
        constexpr double digits = 1 << 22;
        std::vector<vec2> rounded = c_.flat_;
        double size = 0;
        for (const vec2& p : rounded) size = std::max({size, std::abs(p.x), std::abs(p.y)});
        const double unit = size > 0 && size < std::numeric_limits<double>::infinity() ? size / digits : 1;
        for (vec2& p : rounded) p = unit * vec2(std::round(p.x / unit), std::round(p.y / unit));
        auto touching = crossing_charts(*c_.charts_, rounded);
        for (std::size_t k = 0; k < touching.size(); ++k)
            touching[k] = touching[k] && turned_triangle(*c_.charts_, k, rounded) < 0;
        return touching;
    }

    /// What the seams count, each edge once.
    double price_of_seams(std::span<const double> prices) const
    {
        double sum = 0;
        for (std::size_t s = 0; s < c_.seam_.size(); ++s)
            if (c_.seam_[s] && c_.facets_.twin[s] > static_cast<idx>(s)) sum += prices[s];
        return sum;
    }

    /// Sews up some charts, one flag each, until the bound of all is reached. whole: their maps may follow as a whole,
    /// which does not keep borders apart
    void sew_up(const std::vector<char>& wanted, bool whole, budget& limits)
    {
        std::vector<idx> some;
        std::vector<char> flags(c_.mesh_.cells().size(), 0);
        double others = 0, own = 0; // energy, area
        for (std::size_t k = 0; k < wanted.size(); ++k)
        {
            const double area = chart_area(k);
            wanted[k] ? own += area : others += area * c_.energy_[k];
            for (auto i = u(c_.charts_->first_cell[k]); i < u(c_.charts_->first_cell[k + 1]); ++i)
                flags[u(c_.charts_->cell_origins[i])] = wanted[k];
        }
        for (std::size_t c = 0; c < flags.size(); ++c)
            if (flags[c]) some.push_back(static_cast<idx>(c));
        if (some.empty()) return;
        double all = own;
        for (std::size_t k = 0; k < wanted.size(); ++k) all += wanted[k] ? 0 : chart_area(k);
        const double bound = ((0.002 * 4 + 0.998 * c_.params_.charts.mean_distortion) * all - others) / own;
        auto laid = c_.triangles_as_laid();
        if (!sew_laid(
                c_.mesh_, {c_.seam_, laid.uv, some, whole}, c_.params_.charts.seams, bound,
                [&limits] { return limits.proceed(); }, c_.factors_))
            return;
        c_.cut(laid);
        const ideal_elements<triangle> ideal(c_.charts_->surface);
        for (std::size_t k = 0; k < c_.energy_.size(); ++k)
            c_.energy_[k] = area_and_energy(*c_.charts_, k, c_.flat_, ideal).second;
    }

    double chart_area(std::size_t k) const
    {
        double area = 0;
        for (idx c = c_.charts_->first_cell[k]; c < c_.charts_->first_cell[k + 1]; ++c)
        {
            const auto x = c_.charts_->surface.rest(c);
            area += glm::length(glm::cross(x[1] - x[0], x[2] - x[0])) / 2;
        }
        return area;
    }

    /// Has segment() cut the charts, one flag each, that have no map, overlap themselves or are above the bound.
    void mend_rest(const std::vector<char>& bad)
    {
        std::vector<char> wanted(c_.mesh_.cells().size(), 0);
        for (std::size_t k = 0; k < bad.size(); ++k)
            for (auto i = u(c_.charts_->first_cell[k]); i < u(c_.charts_->first_cell[k + 1]); ++i)
                wanted[u(c_.charts_->cell_origins[i])] = bad[k];
        auto seam = c_.seam_;
        segment_rest(wanted);
        if (!c_.report_.complete)
        {
            c_.seam_ = std::move(seam);
            return;
        }
        c_.charts_.emplace(cut_charts(c_.mesh_, c_.facets_, c_.seam_));
        auto flat = c_.flatten(*c_.charts_, {}, std::numeric_limits<int>::max());
        c_.energy_.clear();
        for (const auto& chart : flat.charts) c_.energy_.push_back(chart.energy);
        c_.flat_ = std::move(flat.uv);
        if (c_.report_.complete) c_.mend(c_.unfit());
    }

    /// Area mean over all charts.
    double mean_energy() const
    {
        double sum = 0, area = 0;
        for (std::size_t k = 0; k < c_.energy_.size(); ++k)
        {
            const double own = chart_area(k);
            sum += own * c_.energy_[k];
            area += own;
        }
        return sum / area;
    }

    /// Has segment() cut some triangles, one flag each.
    void segment_rest(const std::vector<char>& wanted)
    {
        std::vector<idx> triangles, number(c_.mesh_.points().size(), -1);
        for (std::size_t c = 0; c < wanted.size(); ++c)
            if (wanted[c]) triangles.push_back(static_cast<idx>(c));
        if (triangles.empty()) return;
        const surface_part part = part_of(c_.mesh_, triangles, c_.seam_, number);
        const auto f = facets(part.charts.surface);
        std::vector<char> together(c_.params_.charts.together.empty() ? 0 : f.twin.size(), 0);
        for (std::size_t s = 0; s < together.size(); ++s) together[s] = c_.params_.charts.together[part.origin(s)];
        auto params = c_.params_.charts;
        params.seams = {};
        params.together = together;
        std::vector<double> factors(c_.factors_.empty() ? 0 : f.twin.size());
        for (std::size_t s = 0; s < factors.size(); ++s) factors[s] = c_.factors_[part.origin(s)];
        params.weights = factors;
        params.tuning.least_fill = 0;
        params.tuning.unite_rounds = std::max(params.tuning.unite_rounds, 6); // few charts, whatever they are like
        params.max_distortion = std::min(params.max_distortion, std::max(4.2, params.mean_distortion));
        params.limits = {std::max(c_.budget_.left(), budget::seconds(1e-6)), c_.asking("charts")};
        // Of large charts that are cut anyway, and of those that many steps would bring no further.
        const auto maps = [this](const chart_mesh& charts, std::span<const vec2> start)
        {
            return c_.flatten(charts, start, std::numeric_limits<int>::max(),
                              start.empty() ? flat_charts::precise::rough : flat_charts::precise::usual);
        };
        const auto made = segment_surface(part.charts.surface, f, maps_by(maps), params);
        for (std::size_t s = 0; s < made.seam.size(); ++s)
            if (made.seam[s]) c_.seam_[part.origin(s)] = 1;
    }

    flat_charts& c_;
    bool rough_ = false;     // see short_cutting::rough()
    std::vector<char> rest_; // seams of what the search found none for, one flag a side
};

inline void flat_charts::cut_short()
{
    short_charts(*this).run();
}

inline std::vector<char> flat_charts::part_overlaps(std::vector<char> bad)
{
    std::vector<idx> some;
    for (std::size_t k = 0; k < bad.size(); ++k)
        if (bad[k] && energy_[k] < std::numeric_limits<double>::infinity())
            for (auto i = u(charts_->first_cell[k]); i < u(charts_->first_cell[k + 1]); ++i)
                some.push_back(charts_->cell_origins[i]);
    if (some.empty()) return bad;
    std::sort(some.begin(), some.end());
    auto laid = triangles_as_laid();
    if (!part_laid(mesh_, {seam_, laid.uv, some}, side_prices(mesh_, facets_, params_.charts.together, factors_)))
        return bad;
    cut(laid);
    const ideal_elements<triangle> ideal(charts_->surface);
    for (std::size_t k = 0; k < energy_.size(); ++k) energy_[k] = area_and_energy(*charts_, k, flat_, ideal).second;
    return unfit();
}

} // namespace taut::impl
