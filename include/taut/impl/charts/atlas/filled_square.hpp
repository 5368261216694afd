// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/charts/atlas/filling_cuts.hpp>
#include <taut/impl/charts/packing/outlines.hpp>
#include <taut/impl/charts/packing/pack.hpp>
#include <taut/impl/charts/packing/pieces.hpp>
#include <taut/pack.hpp>

namespace taut::impl
{

/// Cuts a few charts, across their waists and off their limbs, where the square is used much better then for the length
/// of the cuts. One limb less may gain nothing while others hold the square open, so that cuts are made one after the
/// other, each that which frees most of the room around the charts where none gains by itself; those up to the best
/// stay, if they do so in the final layouts, too. All others are drafts and estimates.
class filled_square
{
public:
    static constexpr double enough = 0.6; ///< use of the square

    /// uv: one per corner of the surface; price: what a seam counts, one a side. All are referred to, but for
    /// `packing` and `limits`, those of each layout.
    filled_square(const mesh<triangle>& m, const facet_table& f, std::span<const vec2> uv,
                  std::span<const double> price, pack_params packing, run_limits limits = {})
        : mesh_(m),
          facets_(f),
          uv_(uv),
          price_(price),
          packing_(std::move(packing)),
          limits_(std::move(limits)),
          area_(area_of(m, 0, m.cell_count())),
          mark_(m.cells().size(), 0)
    {
    }

    /// seam: one flag a side; longest: what all cuts together may count. Returns the seams with those of the cuts.
    std::vector<char> run(std::vector<char> seam, double longest, const std::function<bool()>& proceed)
    {
        constexpr double worth = 0.1; // gain of the use by cost by the root of the area
        constexpr int most = 8;       // cuts
        const double least = worth / std::sqrt(area_);
        std::vector<char> best = seam;
        std::vector<idx> all(mesh_.cells().size());
        std::iota(all.begin(), all.end(), idx(0));
        auto charts = charts_of(all, seam);
        std::vector<char> first = seam;
        const double at_first = use_ = use_of(charts, packing_effort::full, enough);
        if (!(at_first < enough)) return first;
        double best_use = use_of(charts, packing_effort::estimate), use = best_use, spent = 0;
        double cost = 0, best_cost = 0;
        for (int k = 0; k < most && use < enough && proceed(); ++k)
        {
            auto next = next_cut(charts, seam, longest - spent);
            if (next.cut.sides.empty()) break;
            cut(seam, next.cut.sides);
            charts = std::move(next.charts);
            spent += next.cut.price;
            cost += cost_of(next.cut);
            use = use_of(charts, packing_effort::estimate);
            if (!(use - best_use > least * (cost - best_cost))) continue;
            best = seam;
            best_use = use;
            best_cost = cost;
        }
        if (best_cost == 0) return first;
        const double at_best =
            use_of(best, packing_effort::full, std::max(enough, at_first + 1.001 * least * best_cost));
        if (!(at_best - at_first > least * best_cost)) return first;
        use_ = at_best;
        return best;
    }

    /// How much of the square the charts use that run() has returned.
    double use() const { return use_; }

    /// How much of the square charts use, about.
    double use_of(std::span<const char> seam, packing_effort effort = packing_effort::estimate,
                  double enough_here = std::numeric_limits<double>::infinity())
    {
        std::vector<idx> all(mesh_.cells().size());
        std::iota(all.begin(), all.end(), idx(0));
        return use_of(charts_of(all, seam), effort, enough_here);
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    using candidate = std::pair<double, waist_cutting::cut>; // room that is freed, by what the cut costs

    /// A chart as the packer sees it.
    struct laid_chart
    {
        std::vector<idx> triangles;                 // ascending
        std::vector<idx> border;                    // sides
        double area = 0, room = 0;                  // in the plane; see room_of()
        std::optional<std::vector<candidate>> cuts; // once they are known
    };

    struct made_cut
    {
        waist_cutting::cut cut;
        std::vector<laid_chart> charts; // then
    };

    /// Its length, as it counts, and what one more chart does: a corner that is cut off gains as much as it happens to.
    double cost_of(const waist_cutting::cut& one) const
    {
        constexpr double chart = 0.3; // by the root of the area
        return one.price + chart * std::sqrt(area_);
    }

    void cut(std::vector<char>& seam, std::span<const std::size_t> sides) const
    {
        for (const std::size_t s : sides) seam[s] = seam[u(facets_.twin[s])] = 1;
    }

    /// The charts that seams leave of these triangles, which are whole charts before.
    std::vector<laid_chart> charts_of(std::span<const idx> triangles, std::span<const char> seam)
    {
        std::vector<laid_chart> charts;
        for (const idx c : triangles) mark_[u(c)] = 1;
        for (const idx first : triangles)
        {
            if (!std::exchange(mark_[u(first)], char(0))) continue;
            laid_chart one;
            one.triangles.push_back(first);
            for (std::size_t i = 0; i < one.triangles.size(); ++i)
                for (idx s = 3 * one.triangles[i]; s < 3 * one.triangles[i] + 3; ++s)
                    if (const idx twin = facets_.twin[u(s)]; twin < 0 || seam[u(s)])
                        one.border.push_back(s);
                    else if (std::exchange(mark_[u(twin) / 3], char(0)))
                        one.triangles.push_back(twin / 3);
            std::sort(one.triangles.begin(), one.triangles.end());
            std::sort(one.border.begin(), one.border.end());
            for (const idx c : one.triangles)
                one.area += 0.5 * std::abs(orient(at(3 * c), at(3 * c + 1), at(3 * c + 2)).det);
            one.room = room_of(one.border);
            charts.push_back(std::move(one));
        }
        return charts;
    }

    const vec2& at(idx corner) const { return uv_[u(corner)]; }

    double use_of(std::span<const laid_chart> charts, packing_effort effort,
                  double enough_here = std::numeric_limits<double>::infinity()) const
    {
        chart_outlines outlines;
        outlines.first.push_back(0);
        for (const laid_chart& one : charts)
        {
            for (const idx s : one.border)
            {
                outlines.edges.push_back({3 * (s / 3) + (s + 1) % 3, 3 * (s / 3) + (s + 2) % 3});
                outlines.cells.push_back(s / 3);
            }
            outlines.first.push_back(static_cast<idx>(outlines.edges.size()));
            outlines.areas.push_back(one.area);
        }
        return pack_outlined(uv_, outlines, packing_, limits_, effort, enough_here).utilization;
    }

    /// Room that a chart keeps others from, as it were: the mean of its hull and of the square on the long side of its
    /// box.
    double room_of(std::span<const idx> border) const
    {
        std::vector<vec2> points;
        points.reserve(border.size());
        for (const idx s : border) points.push_back(at(3 * (s / 3) + (s + 1) % 3));
        const auto hull = convex_hull(std::move(points));
        double area = 0;
        for (std::size_t k = 2; k < hull.size(); ++k)
        {
            const vec2 a = hull[k - 1] - hull[0], b = hull[k] - hull[0];
            area += 0.5 * (a.x * b.y - a.y * b.x);
        }
        const auto [low, high] = box_in(hull, tightest_axis(hull));
        const double side = std::max(high.x - low.x, high.y - low.y);
        return 0.5 * (area + side * side);
    }

    /// Cuts of a chart that free room, those first that free most.
    std::vector<candidate> candidates(const laid_chart& chart, const std::vector<char>& seam)
    {
        std::vector<candidate> found;
        for (auto& one : waist_cutting(mesh_, chart.triangles, seam, price_).cuts())
        {
            auto with = seam;
            cut(with, one.sides);
            double freed = chart.room;
            for (const laid_chart& part : charts_of(chart.triangles, with)) freed -= part.room;
            if (freed > 0) found.emplace_back(freed / cost_of(one), std::move(one));
        }
        std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
        return found;
    }

    /// The cut with the largest gain of use by cost of a few that free most room; where none has any, the first of
    /// these. longest: what it may count
    made_cut next_cut(std::vector<laid_chart>& charts, const std::vector<char>& seam, double longest)
    {
        constexpr std::size_t charts_tried = 2, cuts_tried = 12; // those that waste most; that free most
        constexpr idx largest = 50'000;                          // triangles: minimum cuts of more take long
        std::vector<std::size_t> wasting(charts.size());
        std::iota(wasting.begin(), wasting.end(), std::size_t(0));
        std::stable_sort(wasting.begin(), wasting.end(),
                         [&](std::size_t a, std::size_t b) { return charts[a].room > charts[b].room; });
        wasting.resize(std::min(wasting.size(), charts_tried));
        std::vector<std::pair<const candidate*, std::size_t>> found; // of which chart
        for (const std::size_t k : wasting)
        {
            if (static_cast<idx>(charts[k].triangles.size()) > largest) continue;
            if (!charts[k].cuts) charts[k].cuts = candidates(charts[k], seam);
            for (const candidate& one : *charts[k].cuts)
                if (one.second.price <= longest) found.emplace_back(&one, k);
        }
        std::stable_sort(found.begin(), found.end(),
                         [](const auto& a, const auto& b) { return a.first->first > b.first->first; });
        found.resize(std::min(found.size(), cuts_tried));
        made_cut best;
        double most = -1;
        const double use = found.empty() ? 0.0 : use_of(charts, packing_effort::draft);
        for (const auto& [one, k] : found)
        {
            auto with = seam;
            cut(with, one->second.sides);
            auto then = charts;
            auto parts = charts_of(charts[k].triangles, with);
            then.erase(then.begin() + static_cast<std::ptrdiff_t>(k));
            std::move(parts.begin(), parts.end(), std::back_inserter(then));
            const double gain = std::max(0.0, use_of(then, packing_effort::draft) - use) / cost_of(one->second);
            if (!(gain > most)) continue;
            most = gain;
            best = {one->second, std::move(then)};
        }
        return best;
    }

    const mesh<triangle>& mesh_;
    const facet_table& facets_;
    std::span<const vec2> uv_;
    std::span<const double> price_;
    pack_params packing_;
    run_limits limits_; // of each layout
    double area_;
    std::vector<char> mark_; // of triangles, 0 between calls
    double use_ = 0;
};

} // namespace taut::impl
