// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <taut/energy/area.hpp>
#include <taut/map/certify.hpp>
#include <taut/map/distortion.hpp>
#include <taut/map/singular_values.hpp>

namespace taut
{

/// How a ratio that is 1 without distortion spreads over the elements.
struct spread
{
    double min = std::numeric_limits<double>::infinity();
    double max = 0;
    double rms = 0; ///< sqrt(mean((ratio - 1)^2)), every element counting 1
};

/// Distortion of a map in all the measures of the literature, and what folds. Energies see the map as it is. Stretch
/// and area are the paper's columns (Table 3) and are taken after scaling the map to the total measure of the rest
/// mesh, the sum of unsigned mapped measures; angles do not depend on scale. Everything but the energies is finite also
/// for flipped elements (they count with |det|), as long as no element is flat.
struct quality
{
    certificate flips;           ///< exact
    means isometric;             ///< |S|^2 (1 + 1/det^2), minimum 4; tetrahedra: shape * area, minimum 2
    means shape;                 ///< |S|^2 / (D det^(2/D)), minimum 1
    means area;                  ///< det + 1/det, minimum 2
    double scale = 1;            ///< factor that gives the map the rest mesh's measure
    spread stretch_l2;           ///< sqrt(|S^-1|^2 / D): how the map back to the surface stretches (Sander et al. 2001)
    spread stretch_linf;         ///< largest singular value of S^-1
    double stretch_l2_total = 0; ///< sqrt of the mean of stretch_l2^2 by rest measure: Sander's norm of the whole map
    spread area_ratio;           ///< mapped / rest measure
    double angular = 0;          ///< mean over all angles of triangles or faces of ((mapped - rest) / rest)^2
};

namespace detail
{

/// Angle at p, exact to rounding from 0 to pi (Kahan): half of it has the chord and the bisector as legs.
template <class Point>
double angle(const Point& p, const Point& q, const Point& r)
{
    const auto a = q - p;
    const auto b = r - p;
    const auto u = a * glm::length(b);
    const auto v = b * glm::length(a);
    return 2 * std::atan2(glm::length(u - v), glm::length(u + v));
}

class spread_sum
{
public:
    void add(double ratio)
    {
        result_.min = std::min(result_.min, ratio);
        result_.max = std::max(result_.max, ratio);
        result_.rms += (ratio - 1) * (ratio - 1);
        ++count_;
    }
    spread result() const
    {
        spread r = result_;
        r.rms = std::sqrt(r.rms / static_cast<double>(count_));
        return r;
    }

private:
    spread result_;
    std::size_t count_ = 0;
};

/// Mean of ((mapped - rest) / rest)^2 over the angles of all triangles of all cells.
template <class Element>
double angular_distortion(const mesh<Element>& m, std::span<const vec<Element::dimension>> x)
{
    double sum = 0;
    std::size_t count = 0;
    const auto u = [](index v) { return static_cast<std::size_t>(v); };
    for (const auto& cell : m.cells())
        for (std::size_t i = 0; i < cell.size(); ++i)
            for (std::size_t j = 0; j < cell.size(); ++j)
                for (std::size_t k = j + 1; k < cell.size(); ++k)
                {
                    if (j == i || k == i) continue;
                    const auto& p = m.points();
                    const double rest = angle(p[u(cell[i])], p[u(cell[j])], p[u(cell[k])]);
                    const double mapped = angle(x[u(cell[i])], x[u(cell[j])], x[u(cell[k])]);
                    sum += (mapped / rest - 1) * (mapped / rest - 1);
                    ++count;
                }
    return sum / static_cast<double>(count);
}

} // namespace detail

/// Measures a map. x: #V image points in the units of `ideal`.
template <class Element>
quality measure_quality(const mesh<Element>& m, const ideal_elements<Element>& ideal,
                        std::span<const vec<Element::dimension>> x)
{
    constexpr int D = Element::dimension;
    quality q;
    q.flips = certify<D>(m.cells(), x, ideal.measure);
    q.isometric = mean(distortion(m, ideal, x, energy::isometric{}), ideal.measure);
    q.shape = mean(distortion(m, ideal, x, energy::shape{}), ideal.measure);
    q.area = mean(distortion(m, ideal, x, energy::area{}), ideal.measure);
    q.angular = detail::angular_distortion(m, x);

    double rest = 0;
    double mapped = 0;
    for (std::size_t c = 0; c < m.cells().size(); ++c)
    {
        rest += ideal.measure[c];
        mapped += std::abs(mapped_element(m, ideal, x, c).det) * ideal.measure[c];
    }
    q.scale = D == 2 ? std::sqrt(rest / mapped) : std::cbrt(rest / mapped);

    detail::spread_sum l2;
    detail::spread_sum linf;
    detail::spread_sum ratio;
    double total = 0;
    for (std::size_t c = 0; c < m.cells().size(); ++c)
    {
        const auto e = mapped_element(m, ideal, x, c);
        const auto sigma = singular_values<D>(q.scale * e.S);
        double sum = 0;
        double volume = 1;
        for (const double s : sigma)
        {
            sum += 1 / (s * s);
            volume *= s;
        }
        l2.add(std::sqrt(sum / D));
        linf.add(1 / sigma.back());
        ratio.add(volume);
        total += ideal.measure[c] * sum / D;
    }
    q.stretch_l2 = l2.result();
    q.stretch_linf = linf.result();
    q.area_ratio = ratio.result();
    q.stretch_l2_total = std::sqrt(total / rest);
    return q;
}

/// The same for the mesh as it is. Throws mesh_error where a cell is flat or inverted at rest.
template <class Element>
quality measure_quality(const mesh<Element>& m, std::span<const vec<Element::dimension>> x)
{
    // In units of the model, so that squares neither overflow nor vanish.
    const double unit = unit_scale(m);
    std::vector<vec<Element::dimension>> scaled(x.begin(), x.end());
    for (auto& p : scaled) p *= unit;
    return measure_quality<Element>(m, ideal_elements<Element>(m, unit), scaled);
}

} // namespace taut
