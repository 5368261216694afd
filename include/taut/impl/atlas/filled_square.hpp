// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/atlas/chart_mesh.hpp>
#include <taut/impl/atlas/filling_cuts.hpp>
#include <taut/impl/packing/outlines.hpp>
#include <taut/impl/packing/pack.hpp>
#include <taut/impl/packing/pieces.hpp>

namespace taut::impl
{

/// Cuts a few charts, across their waists and off their limbs, where the square is used much better then for the length
/// of the cuts. One limb less may gain nothing while others hold the square open, so that cuts are made one after the
/// other, each that which frees most of the room around the charts where none gains by itself; those up to the best
/// stay.
class filled_square
{
public:
    /// uv: one per corner of the surface; price: what a seam counts, one a side. All are referred to, but for
    /// `packing`.
    filled_square(const mesh<triangle>& m, const facet_table& f, std::span<const vec2> uv,
                  std::span<const double> price, pack_params packing)
        : mesh_(m), facets_(f), uv_(uv), price_(price), packing_(std::move(packing))
    {
        for (std::size_t c = 0; c < m.cells().size(); ++c)
        {
            const auto x = m.rest(static_cast<idx>(c));
            area_ += 0.5 * glm::length(glm::cross(x[1] - x[0], x[2] - x[0]));
        }
    }

    /// seam: one flag a side; longest: what all cuts together may count. Returns the seams with those of the cuts.
    std::vector<char> run(std::vector<char> seam, double longest, const std::function<bool()>& proceed)
    {
        constexpr double enough = 0.62, worth = 0.1; // use of the square; its gain by length by the root of the area
        constexpr int most = 8;                      // cuts
        const double root = std::sqrt(area_);
        std::vector<char> best = seam;
        double best_use = use_of(seam), use = best_use, spent = 0;
        for (int k = 0; k < most && use < enough && proceed(); ++k)
        {
            const auto next = next_cut(seam, longest - spent);
            if (next.sides.empty()) break;
            for (const std::size_t s : next.sides) seam[s] = seam[u(facets_.twin[s])] = 1;
            spent += next.price;
            use = use_of(seam);
            if (!(use - best_use > worth * (spent - best_spent_) / root)) continue;
            best = seam;
            best_use = use;
            best_spent_ = spent;
        }
        return best;
    }

    /// How much of the square charts use, about.
    double use_of(std::span<const char> seam, bool draft = false) const
    {
        const auto [charts, flat] = laid(seam);
        return pack_outlined(flat, find_outlines(flat, charts.surface.cells(), charts.first_cell, charts.first_vertex),
                             packing_, draft)
            .utilization;
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    std::pair<chart_mesh, std::vector<vec2>> laid(std::span<const char> seam) const
    {
        std::pair<chart_mesh, std::vector<vec2>> made{cut_charts(mesh_, facets_, seam), {}};
        auto& [charts, flat] = made;
        flat.resize(charts.surface.points().size());
        for (std::size_t i = 0; i < charts.cell_origins.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k)
                flat[u(charts.surface.cells()[i][k])] = uv_[3 * u(charts.cell_origins[i]) + k];
        return made;
    }

    /// Room that triangles keep others from, as it were: the mean of their hull and of the square on the long side of
    /// their box.
    double room(std::span<const idx> triangles) const
    {
        std::vector<vec2> points;
        points.reserve(3 * triangles.size());
        for (const idx c : triangles)
            for (std::size_t k = 0; k < 3; ++k) points.push_back(uv_[3 * u(c) + k]);
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

    using candidate = std::pair<double, waist_cutting::cut>; // room that is freed, by what the cut counts

    /// Cuts of a chart that free room. whole: that of the chart
    std::vector<candidate> candidates(std::span<const idx> own, std::span<const char> seam, double whole) const
    {
        std::vector<candidate> found;
        for (auto& one : waist_cutting(mesh_, own, seam, price_).cuts())
        {
            std::sort(one.beyond.begin(), one.beyond.end());
            std::vector<idx> rest;
            std::set_difference(own.begin(), own.end(), one.beyond.begin(), one.beyond.end(), std::back_inserter(rest));
            const double freed = whole - room(one.beyond) - room(rest);
            if (freed > 0) found.emplace_back(freed / one.price, std::move(one));
        }
        return found;
    }

    /// The cut with the largest gain of use by length of a few that free most room; where none has any, the first of
    /// these. longest: what it may count
    waist_cutting::cut next_cut(std::span<const char> seam, double longest)
    {
        constexpr std::size_t charts_tried = 2, cuts_tried = 12; // those that waste most; that free most
        constexpr idx largest = 50'000;                          // triangles: minimum cuts of more take long
        const auto charts = cut_charts(mesh_, facets_, seam);
        std::vector<std::pair<double, std::vector<idx>>> wasting;
        for (idx k = 0; k < charts.charts(); ++k)
        {
            std::vector<idx> own(charts.cell_origins.begin() + charts.first_cell[u(k)],
                                 charts.cell_origins.begin() + charts.first_cell[u(k) + 1]);
            std::sort(own.begin(), own.end());
            wasting.emplace_back(room(own), std::move(own));
        }
        std::stable_sort(wasting.begin(), wasting.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        wasting.resize(std::min(wasting.size(), charts_tried));
        std::vector<candidate> found;
        for (const auto& [whole, own] : wasting)
        {
            if (static_cast<idx>(own.size()) > largest) continue;
            auto& known = known_[own];
            if (known.empty()) known = candidates(own, seam, whole);
            for (const auto& one : known)
                if (one.second.price <= longest) found.push_back(one);
        }
        std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
        found.resize(std::min(found.size(), cuts_tried));
        std::size_t best = 0;
        double most = 0;
        const double use = found.empty() ? 0.0 : use_of(seam, true);
        for (std::size_t i = 0; i < found.size(); ++i)
        {
            std::vector<char> with(seam.begin(), seam.end());
            for (const std::size_t s : found[i].second.sides) with[s] = with[u(facets_.twin[s])] = 1;
            const double gain = (use_of(with, true) - use) / found[i].second.price;
            if (gain > most) best = i;
            most = std::max(most, gain);
        }
        return found.empty() ? waist_cutting::cut{} : std::move(found[best].second);
    }

    const mesh<triangle>& mesh_;
    const facet_table& facets_;
    std::span<const vec2> uv_;
    std::span<const double> price_;
    pack_params packing_;
    double area_ = 0, best_spent_ = 0;
    std::map<std::vector<idx>, std::vector<candidate>> known_; // of charts, by their triangles
};

} // namespace taut::impl
