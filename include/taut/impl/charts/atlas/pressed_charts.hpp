// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/atlas_run.hpp>
#include <taut/impl/charts/atlas/chart_border.hpp>
#include <taut/impl/charts/atlas/filled_square.hpp>
#include <taut/impl/charts/atlas/flatten_charts.hpp>
#include <taut/impl/charts/packing/outlines.hpp>
#include <taut/impl/charts/packing/pack.hpp>
#include <taut/impl/charts/packing/pieces.hpp>
#include <taut/pack.hpp>
#include <taut/parameterize.hpp>

namespace taut::impl
{

/// The smallest square around points: its first axis, its centre in the frame of that, and its side.
struct least_square
{
    vec2 axis{1, 0}, centre{0, 0};
    double side = 0;

    static least_square of(std::vector<vec2> points)
    {
        piece p;
        p.hull = convex_hull(std::move(points));
        p.axis = tightest_axis(p.hull);
        const double turn = squarest_turn(p);
        const vec2 t(std::cos(turn), std::sin(turn));
        const vec2 axis(t.x * p.axis.x - t.y * p.axis.y, t.x * p.axis.y + t.y * p.axis.x);
        const auto [low, high] = box_in(p.hull, axis);
        return {axis, 0.5 * (low + high), std::max(high.x - low.x, high.y - low.y)};
    }
};

/// Bends charts whose own squares keep the tile large, each into a smaller one: limbs and ends move far for little
/// distortion, as long as they only turn.
class chart_press
{
public:
    /// Refers to the run and to `set`, which is changed; bound: of the mean energy at the common scale
    chart_press(atlas_run& run, chart_set& set, pack_params packing, double bound)
        : run_(run), set_(set), packing_(std::move(packing)), bound_(bound), ideal_(set.charts.surface)
    {
    }

    /// The chart whose square keeps the tile large, where charts use little of it; -1: none does. What is hardly
    /// distorted is not to be: what is plane, or unrolls, keeps its straight lines.
    idx leader()
    {
        constexpr idx few = 16;         // charts
        constexpr double leads = 0.95;  // the square of the chart by the tile
        constexpr double least = 0.5;   // of what is allowed
        constexpr idx largest = 20'000; // triangles: more take longer than all else
        const auto& charts = set_.charts;
        if (charts.charts() > few) return -1;
        for (const double e : set_.energy)
            if (!(e < std::numeric_limits<double>::infinity())) return -1;
        const auto outlines = find_outlines(set_.uv, charts.surface.cells(), charts.first_cell, charts.first_vertex);
        const double use =
            pack_outlined(set_.uv, outlines, packing_, {run_.limits("pack").time_limit, {}}, packing_effort::draft)
                .utilization;
        idx leader = -1;
        double side = 0;
        for (idx k = 0; k < charts.charts(); ++k)
            if (const double own = least_square::of(points(k)).side; own > side)
            {
                side = own;
                leader = k;
            }
        if (leader < 0 || charts.first_cell[u(leader) + 1] - charts.first_cell[u(leader)] > largest) return -1;
        const bool bent = set_.energy[u(leader)] - 4 > least * (bound_ - 4);
        return bent && use < filled_square::enough && use * side * side > leads * laid_area() ? leader : -1;
    }

    /// Bends one after the other, until the bound is reached or it gains nothing. most: energy of a chart. Returns
    /// whether any is in a smaller square then.
    bool run(double most)
    {
        most_ = most;
        constexpr int rounds = 8;
        for (int k = 0; k < rounds && run_.report.complete && mean() < bound_; ++k)
            if (const idx chart = leader(); chart < 0 || !bend(chart)) break;
        return changed_;
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    std::span<vec2> own(idx chart)
    {
        const auto first = u(set_.charts.first_vertex[u(chart)]);
        return std::span(set_.uv).subspan(first, u(set_.charts.first_vertex[u(chart) + 1]) - first);
    }
    std::vector<vec2> points(idx chart)
    {
        const auto x = own(chart);
        return {x.begin(), x.end()};
    }

    mat2 shape(std::size_t c) const
    {
        return shape_matrix<2>(set_.charts.surface.cells()[c], std::span<const vec2>(set_.uv), ideal_.inverse[c]);
    }

    double laid_area() const
    {
        double sum = 0;
        for (std::size_t c = 0; c < ideal_.measure.size(); ++c) sum += ideal_.measure[c] * glm::determinant(shape(c));
        return sum;
    }

    /// Energy of all charts at their common scale, as reported: that of equal areas.
    double mean() const
    {
        double area = 0, in_plane = 0, stretch = 0, shrink = 0; // |S|^2 and |S^-1|^2 by area
        for (std::size_t c = 0; c < ideal_.measure.size(); ++c)
        {
            const mat2 S = shape(c);
            const double det = glm::determinant(S);
            if (!(det > 0)) return std::numeric_limits<double>::infinity();
            area += ideal_.measure[c];
            in_plane += ideal_.measure[c] * det;
            stretch += ideal_.measure[c] * norm2(S);
            shrink += ideal_.measure[c] * (norm2(S) / (det * det));
        }
        return stretch / in_plane + shrink * in_plane / (area * area);
    }

    /// Returns whether all of a step was made.
    bool bend(idx chart)
    {
        constexpr double step = 0.05, stiffness = 200; // of the side; springs by the mean energy, about
        const auto x = own(chart);
        const auto square = least_square::of(points(chart));
        for (vec2& p : x) p = vec2(glm::dot(square.axis, p), square.axis.x * p.y - square.axis.y * p.x) - square.centre;
        const mesh<triangle> alone = chart_alone(set_.charts, u(chart));
        if (!check(alone, {.one_boundary = false}).empty()) return false;
        parameterize_params params{.constraints = taut::constraints<triangle>(alone),
                                   .initial = points(chart),
                                   .placement = placement::as_solved,
                                   .holes = true,
                                   .no_overlap = true,
                                   .tuning = {.apart = true}};
        std::vector<idx> border; // a vertex is on one loop, once
        for_each_border_side(set_.charts, chart, [&](idx from, idx) { border.push_back(from); });
        const idx first = set_.charts.first_vertex[u(chart)];
        const vec2 half(0.5 * (1 - step) * square.side);
        const double weight = stiffness / (static_cast<double>(border.size()) * area_of(alone, 0, alone.cell_count()));
        for (const idx v : border)
            if (const vec2 inside = glm::clamp(set_.uv[u(v)], -half, half); inside != set_.uv[u(v)])
                params.constraints.spring(v - first, inside, weight);
        params.solve = rough_solve(10);
        const auto map = parameterize(run_.device, alone, params, run_.limits("pack"));
        return map.uv.size() == x.size() && move(chart, map.uv, square.side);
    }

    /// Moves a chart towards a map, as far as the bound allows and it does not overlap itself. Returns whether it went
    /// all the way, to a smaller square.
    bool move(idx chart, std::span<const vec2> to, double side)
    {
        constexpr int halvings = 4;
        constexpr double least_gain = 0.01; // of the use
        const auto from = points(chart);
        auto best = from;
        const auto x = own(chart);
        const double before = laid_area() / (side * side);
        double part = 1, made = 0;
        for (int k = 0; k < halvings && made < 1; ++k)
        {
            for (std::size_t v = 0; v < x.size(); ++v) x[v] = from[v] + part * (to[v] - from[v]);
            const bool fits = mean() <= bound_ &&
                              area_and_energy(set_.charts, u(chart), set_.uv, ideal_).second <= most_ &&
                              !overlaps_itself(set_.charts, u(chart), set_.uv);
            if (fits)
            {
                made = part;
                best = points(chart);
            }
            part += std::ldexp(fits ? 1.0 : -1.0, -k - 1);
        }
        std::copy(best.begin(), best.end(), x.begin());
        const double then = least_square::of(points(chart)).side;
        const bool gains = laid_area() / (then * then) > (1 + least_gain) * before;
        if (!gains) std::copy(from.begin(), from.end(), x.begin());
        set_.energy[u(chart)] = area_and_energy(set_.charts, u(chart), set_.uv, ideal_).second;
        changed_ = changed_ || gains;
        return gains && made == 1;
    }

    atlas_run& run_;
    chart_set& set_;
    pack_params packing_;
    double bound_, most_ = 0;
    bool changed_ = false;
    ideal_elements<triangle> ideal_;
};

} // namespace taut::impl
