// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/cutting/overlap_layers.hpp>
#include <taut/impl/charts/atlas/cutting/zip.hpp>

namespace taut::impl
{

/// Gives small charts to their neighbours. One is moved so that an edge lies on that of the neighbour, those with the
/// longest border to it first, where nothing of that lies, and is sewn to it from there. Others of these charts may lie
/// there, or what follows the seam.
class crumb_giving
{
public:
    static constexpr double bad_energy = 10;

    /// Refers to both. bound: of the mean energy of what is moved or follows
    crumb_giving(const rest_surface& rest, flat_surface& flat, double bound)
        : rest_(rest), flat_(flat), bound_(std::min(bound, bad_energy)), grid_(rest, flat.uv), zipper_(rest, 100)
    {
    }

    /// Returns how many charts were given away.
    int run()
    {
        number_fans(rest_, flat_);
        const auto [chart, charts] = pieces_between(rest_.facets, flat_.seam);
        chart_ = chart;
        std::vector<std::vector<idx>> crumbs(u(charts));
        for (idx c = 0; c < rest_.triangles(); ++c)
            if (auto& own = crumbs[u(chart_[u(c)])]; own.size() <= largest) own.push_back(c);
        for (idx k = 0; k < charts; ++k) is_crumb_.push_back(crumbs[u(k)].size() <= largest);
        int given = 0;
        for (idx k = 0; k < charts; ++k) given += is_crumb_[u(k)] && give(crumbs[u(k)]);
        return given;
    }

private:
    static constexpr std::size_t largest = 100; // triangles
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// The sides of a chart beside charts that are no crumbs: those of the longest border first, the longest first.
    std::vector<idx> borders(std::span<const idx> crumb) const
    {
        std::vector<std::pair<idx, double>> shared; // chart, length
        std::vector<idx> sides;
        const auto length = [&](idx s) -> double&
        {
            const idx k = chart_[u(rest_.twin(s) / 3)];
            for (auto& [other, sum] : shared)
                if (other == k) return sum;
            return shared.emplace_back(k, 0).second;
        };
        for (const idx c : crumb)
            for (idx s = 3 * c; s < 3 * c + 3; ++s)
                if (rest_.twin(s) >= 0 && flat_.seam[u(s)] && !is_crumb_[u(chart_[u(rest_.twin(s) / 3)])])
                {
                    sides.push_back(s);
                    length(s) += rest_.length[u(s)];
                }
        std::stable_sort(sides.begin(), sides.end(),
                         [&](idx a, idx b)
                         {
                             const double x = length(a), y = length(b);
                             return x != y ? x > y : rest_.length[u(a)] > rest_.length[u(b)];
                         });
        return sides;
    }

    bool give(std::span<const idx> crumb)
    {
        std::vector<vec2> before;
        for (const idx c : crumb) before.insert(before.end(), &flat_.uv[3 * u(c)], &flat_.uv[3 * u(c)] + 3);
        for (const idx side : borders(crumb))
        {
            move(crumb, before, side);
            if (!fits(crumb, chart_[u(rest_.twin(side) / 3)])) continue;
            sew(side);
            return true;
        }
        for (std::size_t i = 0; i < before.size(); ++i) flat_.uv[3 * u(crumb[i / 3]) + i % 3] = before[i];
        return false;
    }

    /// Moves a chart so that a side of it lies on its twin.
    void move(std::span<const idx> crumb, std::span<const vec2> before, idx side)
    {
        const idx first = rest_surface::start_corner(side), last = rest_surface::end_corner(side);
        const vec2 to_first = flat_.uv[u(rest_surface::end_corner(rest_.twin(side)))];
        const vec2 to_last = flat_.uv[u(rest_surface::start_corner(rest_.twin(side)))];
        const auto i = 3 * u(static_cast<idx>(std::find(crumb.begin(), crumb.end(), side / 3) - crumb.begin()));
        const vec2 a = before[i + u(first % 3)], b = before[i + u(last % 3)], d = b - a, e = to_last - to_first;
        const double size = glm::length(d) * glm::length(e);
        const double cosine = glm::dot(d, e) / size, sine = (d.x * e.y - d.y * e.x) / size;
        for (std::size_t k = 0; k < before.size(); ++k)
        {
            const idx corner = 3 * crumb[k / 3] + static_cast<idx>(k % 3);
            const vec2 p = before[k] - 0.5 * (a + b);
            vec2& x = flat_.uv[u(corner)];
            x = 0.5 * (to_first + to_last) + vec2(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y);
            if (flat_.fan[u(corner)] == flat_.fan[u(first)]) x = to_first;
            if (flat_.fan[u(corner)] == flat_.fan[u(last)]) x = to_last;
        }
    }

    /// Whether a chart where it is lies on nothing of another one, but perhaps where they have a vertex in common, as
    /// they are to be sewn up there.
    bool fits(std::span<const idx> crumb, idx other) const
    {
        double energy = 0, area = 0;
        for (const idx c : crumb)
        {
            energy += energy_of(rest_, flat_.uv, c);
            area += rest_.weight[u(c)];
        }
        if (!(energy <= bound_ * area)) return false;
        std::vector<idx> own; // vertices
        for (const idx c : crumb)
            own.insert(own.end(), rest_.surface.cells()[u(c)].begin(), rest_.surface.cells()[u(c)].end());
        std::sort(own.begin(), own.end());
        const auto touches = [&](idx c)
        {
            const auto& t = rest_.surface.cells()[u(c)];
            return std::any_of(t.begin(), t.end(),
                               [&](idx v) { return std::binary_search(own.begin(), own.end(), v); });
        };
        const std::span<const vec2> uv(flat_.uv);
        return std::none_of(crumb.begin(), crumb.end(),
                            [&](idx c)
                            {
                                const auto t = uv.subspan(3 * u(c)).first<3>();
                                return grid_.any_near(t,
                                                      [&](idx d) {
                                                          return chart_[u(d)] == other && !touches(d) &&
                                                                 lie_on_each_other(t, uv.subspan(3 * u(d)).first<3>());
                                                      });
                            });
    }

    /// Sews up an edge whose sides lie on each other, and those that follow at both ends.
    void sew(idx side)
    {
        join(rest_surface::start_corner(side), rest_surface::end_corner(rest_.twin(side)));
        join(rest_surface::end_corner(side), rest_surface::start_corner(rest_.twin(side)));
        set_seam(rest_, flat_.seam, side, 0);
        for (idx tip : {rest_.start(side), rest_.end(side)})
            while (!rest_.rim[u(tip)] && seam_degree(rest_, flat_.seam, tip) == 1)
            {
                const zip z = zipper_.look(flat_, tip);
                double area = 0;
                for (const idx c : z.triangles) area += rest_.weight[u(c)];
                if (!(z.more <= (bound_ - 4) * area)) break;
                zipper_.apply(flat_, z);
                tip = rest_.end(z.side);
            }
    }

    /// Makes the fan of a corner a part of that of another.
    void join(idx corner, idx to)
    {
        const idx from = flat_.fan[u(corner)], fan = flat_.fan[u(to)];
        if (from == fan) return;
        for (const idx s : rest_.sides.row(rest_.vertex(corner)))
            if (idx& f = flat_.fan[u(rest_surface::start_corner(s))]; f == from) f = fan;
        flat_.fan_cells[u(fan)] += std::exchange(flat_.fan_cells[u(from)], 0);
    }

    const rest_surface& rest_;
    flat_surface& flat_;
    double bound_;
    triangle_grid grid_;
    zipper zipper_;
    std::vector<idx> chart_;     // one a triangle
    std::vector<char> is_crumb_; // one a chart
};

} // namespace taut::impl
