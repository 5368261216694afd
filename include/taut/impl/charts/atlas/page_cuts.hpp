// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/atlas_run.hpp>
#include <taut/impl/charts/atlas/cutting/minimum_cut.hpp>
#include <taut/impl/charts/atlas/surface_part.hpp>
#include <taut/impl/charts/packing/pieces.hpp>

namespace taut::impl
{

/// Cuts charts that are larger than a tile at a given texel density, along short seams across them, until each fits
/// with its padding. The parts keep their maps.
class page_cuts
{
public:
    page_cuts(const atlas_surface& of, chart_set& set) : of_(of), set_(set), prices_(of.prices())
    {
        const pack_params& p = of.params.packing;
        int resolution = p.resolution;
        while (2 * resolution <= p.max_resolution) resolution *= 2;
        constexpr double cells = 0.98; // what rounding to the packer's grid leaves
        const double border = 2 * (p.padding + p.rounding * resolution + (p.align > 1 ? p.align : 0));
        size_ = cells * vec2(resolution - border, resolution * p.aspect - border) / p.texels_per_unit;
    }

    /// Returns how many charts were cut; the rest fits, or is one triangle or polygon each.
    idx run()
    {
        idx cut_charts = 0;
        std::vector<char> left_alone(of_.surface.cells().size(), 0);
        for (bool again = size_.x > 0 && size_.y > 0; again;)
        {
            again = false;
            auto flat = laid(set_);
            for (std::size_t k = 0; k < set_.energy.size(); ++k)
            {
                char& alone = left_alone[u(set_.charts.first_triangle(k))];
                if (alone || !(set_.energy[k] < std::numeric_limits<double>::infinity()) || fits(k)) continue;
                if (!cut(k, flat))
                {
                    alone = 1;
                    continue;
                }
                again = true;
                ++cut_charts;
            }
            if (again) set_ = impl::cut(of_, std::move(flat));
        }
        if (cut_charts > 0) measure(set_);
        return cut_charts;
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    double density(std::size_t k) const
    {
        const auto& all = of_.params.packing.densities;
        return all.empty() ? 1 : all[u(set_.charts.first_triangle(k))];
    }

    std::vector<vec2> points(std::size_t k) const
    {
        const auto first = set_.uv.begin();
        return {first + set_.charts.first_vertex[k], first + set_.charts.first_vertex[k + 1]};
    }

    /// Returns whether a chart fits into a tile in a pose of the packer.
    bool fits(std::size_t k) const
    {
        const auto hull = convex_hull(points(k));
        const bool rotate = of_.params.packing.rotate;
        const vec2 axis = rotate ? tightest_axis(hull) : vec2(1, 0);
        const int turns = !rotate ? 1 : set_.charts.charts() <= 200 ? 8 : 4;
        for (int turn = 0; turn < turns; ++turn)
        {
            const double angle = 2 * std::numbers::pi * turn / turns;
            const vec2 t(std::cos(angle), std::sin(angle));
            const auto [low, high] = box_in(hull, {t.x * axis.x - t.y * axis.y, t.x * axis.y + t.y * axis.x});
            const vec2 box = density(k) * (high - low);
            if (box.x <= size_.x && box.y <= size_.y) return true;
        }
        return false;
    }

    /// Where a chart is cut: about half-way along the side of its box that is too long.
    struct waist
    {
        vec2 axis{1, 0};
        double middle = 0, slack = 0; ///< parts of equal length fit for cuts within the slack
    };

    waist waist_of(std::size_t k) const
    {
        const bool rotate = of_.params.packing.rotate;
        const auto hull = convex_hull(points(k));
        const vec2 axis = rotate ? tightest_axis(hull) : vec2(1, 0);
        const auto [low, high] = box_in(hull, axis);
        const vec2 box = high - low;
        vec2 tile = size_ / density(k);
        if (rotate && (box.x < box.y) != (tile.x < tile.y)) std::swap(tile.x, tile.y);
        const bool across = box.y * tile.x > box.x * tile.y; // the side that is longer for its room
        const double length = across ? box.y : box.x, room = across ? tile.y : tile.x;
        const double parts = std::max(2.0, std::ceil(length / (0.9 * room)));
        return {across ? vec2(-axis.y, axis.x) : axis,
                (across ? low.y : low.x) + std::floor(0.5 * parts) / parts * length,
                0.5 * std::max(room - length / parts, 0.05 * length / parts)};
    }

    bool cut(std::size_t k, laid_surface& flat) const
    {
        const auto& charts = set_.charts;
        std::vector<idx> triangles(charts.cell_origins.begin() + charts.first_cell[k],
                                   charts.cell_origins.begin() + charts.first_cell[k + 1]);
        std::sort(triangles.begin(), triangles.end());
        const surface_part part = part_of(of_.surface, triangles, set_.seam);
        rest_surface rest = rest_surface::of(part.charts.surface, part.charts.surface.cell_count());
        const auto& together = of_.params.charts.together;
        bool divides = false; // is more than one polygon
        for (idx s = 0; s < static_cast<idx>(rest.price.size()); ++s)
        {
            rest.price[u(s)] = prices_[part.origin(u(s))];
            divides = divides || (rest.twin(s) >= 0 && (together.empty() || !together[part.origin(u(s))]));
        }
        if (!divides) return false;
        const waist at = waist_of(k);
        std::vector<std::pair<double, idx>> order; // triangles by their middles
        for (std::size_t c = 0; c < part.triangles.size(); ++c)
        {
            const auto x = [&](std::size_t corner) { return glm::dot(flat.uv[part.origin(3 * c + corner)], at.axis); };
            order.emplace_back((x(0) + x(1) + x(2)) / 3, static_cast<idx>(c));
        }
        std::sort(order.begin(), order.end());
        std::vector<idx> near{order.front().second}, far{order.back().second};
        for (std::size_t i = 1; i + 1 < order.size(); ++i)
            if (order[i].first < at.middle - at.slack)
                near.push_back(order[i].second);
            else if (order[i].first > at.middle + at.slack)
                far.push_back(order[i].second);
        const std::vector<char> none(rest.price.size(), 0);
        const auto sides = minimum_cutting(rest).run(none, near, far);
        for (const idx s : sides) flat.seam[part.origin(u(s))] = flat.seam[part.origin(u(rest.twin(s)))] = 1;
        return !sides.empty();
    }

    const atlas_surface& of_;
    chart_set& set_;
    std::vector<double> prices_;
    vec2 size_{0.0}; // of a tile, in units of the surface
};

} // namespace taut::impl
