// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/charts.hpp>
#include <taut/energies.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/charts/atlas/cutting/rest_surface.hpp>
#include <taut/impl/charts/atlas/surface_part.hpp>
#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/impl/core/exact/crossings.hpp>
#include <taut/impl/core/start/isometric_newton.hpp>

namespace taut::impl
{

/// A surface with seams and a map without flips of what these leave connected.
struct flat_surface
{
    std::vector<char> seam;                                  ///< one a side, the same on both sides of an edge
    std::vector<vec2> uv;                                    ///< one a corner
    std::vector<idx> fan;                                    ///< one a corner: the vertex of the cut surface
    std::vector<idx> fan_cells;                              ///< triangles of each
    double energy = std::numeric_limits<double>::infinity(); ///< area mean, holes left out
};

/// Seam sides that start at a vertex.
inline idx seam_degree(const rest_surface& rest, std::span<const char> seam, idx v)
{
    idx degree = 0;
    for (const idx s : rest.sides.row(v)) degree += seam[rest_surface::u(s)] != 0 && rest.twin(s) >= 0;
    return degree;
}

inline void set_seam(const rest_surface& rest, std::vector<char>& seam, idx side, char value)
{
    seam[rest_surface::u(side)] = value;
    if (rest.twin(side) >= 0) seam[rest_surface::u(rest.twin(side))] = value;
}

/// Sum over the seams, each once. each: one a side
inline double seam_sum(const rest_surface& rest, std::span<const char> seam, std::span<const double> each)
{
    double sum = 0;
    for (std::size_t s = 0; s < seam.size(); ++s)
        if (seam[s] && rest.twin(static_cast<idx>(s)) > static_cast<idx>(s)) sum += each[s];
    return sum;
}

/// What the seams count.
inline double seam_price(const rest_surface& rest, std::span<const char> seam)
{
    return seam_sum(rest, seam, rest.price);
}

inline double seam_length(const rest_surface& rest, std::span<const char> seam)
{
    return seam_sum(rest, seam, rest.length);
}

/// Numbers the vertices of the cut surface anew.
inline void number_fans(const rest_surface& rest, flat_surface& flat)
{
    vertex_fans fans = fans_between(rest.surface, rest.facets, flat.seam);
    flat.fan = std::move(fans.of_corner);
    flat.fan_cells.assign(fans.first_corner.size(), 0);
    for (const idx f : flat.fan) ++flat.fan_cells[rest_surface::u(f)];
}

/// energy::isometric of a triangle; +infinity where it is flipped or flat.
inline double isometric_energy(const mat2& inverse, const vec2& a, const vec2& b, const vec2& c)
{
    const mat2 S = shape_matrix(mat2(b - a, c - a), inverse);
    const double det = S[0][0] * S[1][1] - S[1][0] * S[0][1];
    if (!(det > 0)) return std::numeric_limits<double>::infinity();
    return norm2(S) * (1 + 1 / (det * det));
}

/// The energy of a triangle times its weight.
inline double energy_of(const rest_surface& rest, std::span<const vec2> uv, idx c)
{
    const std::size_t k = 3 * rest_surface::u(c);
    return rest.weight[rest_surface::u(c)] *
           isometric_energy(rest.inverse[rest_surface::u(c)], uv[k], uv[k + 1], uv[k + 2]);
}

/// Area mean over what is no hole.
inline double mean_energy(const rest_surface& rest, std::span<const vec2> uv)
{
    double sum = 0;
    for (idx c = 0; c < rest.first_span; ++c) sum += energy_of(rest, uv, c);
    return sum / rest.total;
}

/// The cut surface: one point and one place a fan that is in use.
struct cut_surface
{
    std::vector<vec3> points;
    std::vector<vec2> uv;
    std::vector<std::array<idx, 3>> cells;

    static cut_surface of(const rest_surface& rest, const flat_surface& flat)
    {
        cut_surface cut;
        std::vector<idx> number(flat.fan_cells.size(), -1);
        cut.cells.resize(rest.surface.cells().size());
        for (std::size_t corner = 0; corner < flat.fan.size(); ++corner)
        {
            idx& n = number[rest_surface::u(flat.fan[corner])];
            if (n < 0)
            {
                n = static_cast<idx>(cut.points.size());
                cut.points.push_back(rest.surface.points()[rest_surface::u(rest.vertex(static_cast<idx>(corner)))]);
                cut.uv.push_back(flat.uv.empty() ? vec2(0.0) : flat.uv[corner]);
            }
            cut.cells[corner / 3][corner % 3] = n;
        }
        return cut;
    }
};

/// Newton's method on a whole map.
class whole_newton
{
public:
    /// Refers to its arguments; seams stay as they are.
    whole_newton(const rest_surface& rest, flat_surface& flat)
        : rest_(rest),
          flat_(flat),
          cut_(cut_surface::of(rest, flat)),
          newton_(cut_.points, cut_.cells, std::vector<char>(cut_.points.size(), 0), rest.weight),
          here_(newton_.value(cut_.uv))
    {
    }
    whole_newton(const whole_newton&) = delete;
    whole_newton& operator=(const whole_newton&) = delete;

    /// Makes steps until one gains less than tolerance times the energy, or more like it would not lead below a bound:
    /// gains halve at least. Sets the map and its energy. Returns how many were made.
    int run(int steps, double tolerance, double bound = std::numeric_limits<double>::infinity())
    {
        int made = 0;
        while (made < steps && here_ < std::numeric_limits<double>::infinity())
        {
            const double gain = here_ - newton_.step(cut_.uv, here_);
            here_ -= gain;
            ++made;
            if (!(gain > tolerance * here_) || here_ - gain > bound) break;
        }
        for (std::size_t corner = 0; corner < flat_.fan.size(); ++corner)
            flat_.uv[corner] = cut_.uv[rest_surface::u(cut_.cells[corner / 3][corner % 3])];
        flat_.energy = mean_energy(rest_, flat_.uv);
        return made;
    }

private:
    const rest_surface& rest_;
    flat_surface& flat_;
    cut_surface cut_;
    isometric_newton newton_;
    double here_;
};

/// Newton steps of the whole map, until one gains less than tolerance times the energy. Sets flat.energy.
inline int relax(const rest_surface& rest, flat_surface& flat, int steps, double tolerance)
{
    return whole_newton(rest, flat).run(steps, tolerance);
}

/// Calls f(side, side) for the pairs of border edges of the same chart whose images meet, until it returns false;
/// exact.
template <class F>
void for_each_border_crossing(const rest_surface& rest, const flat_surface& flat, F&& f)
{
    const auto u = rest_surface::u;
    std::vector<vec2> place(flat.fan_cells.size(), vec2(0.0));
    std::vector<idx> border;
    for (std::size_t s = 0; s < flat.seam.size(); ++s)
    {
        place[u(flat.fan[s])] = flat.uv[s];
        if (rest.facets.twin[s] < 0 || flat.seam[s]) border.push_back(static_cast<idx>(s));
    }
    const auto [chart, charts] = pieces_between(rest.facets, flat.seam);
    std::vector<std::array<idx, 2>> edges(border.size());
    std::vector<idx> sides(border.size());
    const auto first = counting_sort(
        border.size(), u(charts), [&, &chart = chart](std::size_t i) { return chart[u(border[i] / 3)]; },
        [&](std::size_t i, std::size_t at)
        {
            sides[at] = border[i];
            edges[at] = {flat.fan[u(rest_surface::start_corner(border[i]))],
                         flat.fan[u(rest_surface::end_corner(border[i]))]};
        });
    bool more = true;
    for (std::size_t k = 0; k + 1 < first.size() && more; ++k)
    {
        const idx* const own = sides.data() + first[k];
        for_each_meeting(std::span(edges).subspan(u(first[k]), u(first[k + 1] - first[k])), place,
                         [&](std::size_t i, std::size_t j) { return more = f(own[i], own[j]); });
    }
}

/// The number of these pairs, counted up to `most`.
inline std::size_t border_crossings(const rest_surface& rest, const flat_surface& flat, std::size_t most)
{
    std::size_t count = 0;
    for_each_border_crossing(rest, flat, [&](idx, idx) { return ++count < most; });
    return count;
}

/// Charts of a surface as they lie in the plane.
struct laid_seams
{
    std::vector<char>& seam;   ///< one a side of the surface
    std::vector<vec2>& uv;     ///< one a corner
    std::span<const idx> some; ///< triangles of whole charts, ascending: what is changed
    bool whole = true;         ///< their maps may follow as a whole
};

/// Some charts of a surface by themselves, with their maps.
struct laid_part
{
    surface_part part;
    rest_surface rest;
    flat_surface flat;

    /// kept: sides that stay seams, or empty; factors: what a unit of length of a seam counts along each side, or empty
    static laid_part of(const mesh<triangle>& m, const laid_seams& laid, std::span<const char> kept,
                        std::span<const double> factors)
    {
        std::vector<char> given(kept.begin(), kept.end());
        given.resize(3 * m.cells().size(), 0);
        surface_part part = part_of(m, laid.some, given);
        rest_surface rest = rest_surface::of(part.charts.surface, part.charts.surface.cell_count());
        if (!factors.empty())
            for (std::size_t s = 0; s < rest.price.size(); ++s) rest.price[s] *= factors[part.origin(s)];
        flat_surface flat;
        flat.seam.resize(rest.facets.twin.size(), 0);
        flat.uv.resize(flat.seam.size());
        for (std::size_t s = 0; s < flat.seam.size(); ++s)
        {
            flat.seam[s] = laid.seam[part.origin(s)] && rest.facets.twin[s] >= 0;
            flat.uv[s] = laid.uv[part.origin(s)];
        }
        number_fans(rest, flat);
        flat.energy = mean_energy(rest, flat.uv);
        return {std::move(part), std::move(rest), std::move(flat)};
    }

    /// Gives seams and maps back to the surface.
    void write(const laid_seams& laid) const
    {
        for (std::size_t s = 0; s < flat.seam.size(); ++s)
        {
            if (rest.facets.twin[s] >= 0) laid.seam[part.origin(s)] = flat.seam[s];
            laid.uv[part.origin(s)] = flat.uv[s];
        }
    }
};

} // namespace taut::impl
