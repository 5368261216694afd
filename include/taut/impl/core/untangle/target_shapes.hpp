// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <taut/impl/core/mesh/facets.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/impl/core/mesh/target_shape.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::impl
{

/// Estimated size of the image, in the unit of x: its signed measure where the boundary is pinned, and that of the box
/// around the fixed vertices or all vertices otherwise.
template <class Element>
double expected_measure(const untangle_problem<Element>& problem, const std::vector<vec<Element::dimension>>& x)
{
    constexpr int D = Element::dimension;
    const auto& m = problem.rest;
    double sum = 0;
    for (const auto& t : m.cells())
    {
        typename Element::mapped_corners corner;
        for (std::size_t k = 0; k < t.size(); ++k) corner[k] = x[static_cast<std::size_t>(t[k])];
        sum += Element::measure_factor * Element::determinant(corner);
    }
    if (problem.outline_pinned() && sum > 0) return sum;
    const auto box = [&](bool all)
    {
        vec<D> low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
        for (std::size_t v = 0; v < x.size(); ++v)
            for (int k = 0; k < D; ++k)
                if (all || problem.held.test(v, k))
                {
                    low[k] = std::min(low[k], x[v][k]);
                    high[k] = std::max(high[k], x[v][k]);
                }
        double volume = 1;
        for (int k = 0; k < D; ++k) volume *= high[k] - low[k];
        return volume;
    };
    for (const bool all : {false, true})
        if (const double volume = box(all); volume > 0 && std::isfinite(volume)) return 0.75 * volume;
    return 1;
}

/// Scales the shapes to this total measure.
template <int D>
void normalize(std::vector<target_shape<D>>& shapes, double measure)
{
    double total = 0;
    for (const auto& s : shapes) total += s.weight;
    const double factor = std::pow(total / measure, 1.0 / D);
    for (auto& s : shapes)
    {
        s.inverse *= factor;
        s.weight /= total;
    }
}

/// Rest shapes of the elements, weighted by measure. Flat ones are made a little thicker, so that they are stiff.
template <class Element>
std::vector<target_shape<Element::dimension>> rest_shapes(const mesh<Element>& m, double measure)
{
    constexpr int D = Element::dimension;
    constexpr double thinnest = 1e-6;
    const double unit = unit_scale(m);
    std::vector<target_shape<D>> shapes(m.cells().size());
    for (std::size_t c = 0; c < shapes.size(); ++c)
    {
        mat<D> W = ideal_of(m, static_cast<idx>(c), unit);
        double longest = 0;
        for (int k = 0; k < D; ++k)
            if (std::isfinite(glm::dot(W[k], W[k]))) longest = std::max(longest, glm::length(W[k]));
        if (!(longest > 0)) longest = 1e-12; // a point
        double measure_here = Element::measure_factor;
        for (int k = 0; k < D; ++k)
        {
            for (int i = 0; i < k; ++i)
                if (!std::isfinite(W[k][i])) W[k][i] = 0;
            if (!(W[k][k] > thinnest * longest)) W[k][k] = thinnest * longest;
            measure_here *= W[k][k];
        }
        shapes[c] = {invert_upper(W), measure_here};
    }
    normalize(shapes, measure);
    return shapes;
}

/// Target shapes of the problem: those given, or those at rest.
template <class Element>
std::vector<target_shape<Element::dimension>> shapes_wanted(const untangle_problem<Element>& problem, double measure)
{
    if (problem.wanted.empty()) return rest_shapes(problem.rest, measure);
    std::vector<target_shape<Element::dimension>> shapes;
    for (const auto& W : problem.wanted)
    {
        double weight = Element::measure_factor;
        for (int k = 0; k < Element::dimension; ++k) weight *= W[k][k];
        shapes.push_back({invert_upper(W), weight});
    }
    normalize(shapes, measure);
    return shapes;
}

/// Regular target shapes of one size.
template <class Element>
std::vector<target_shape<Element::dimension>> regular_shapes(const mesh<Element>& m, double measure)
{
    constexpr int D = Element::dimension;
    const auto all = regular_elements<Element>(m.cells().size(), measure);
    const double weight = 1 / static_cast<double>(m.cells().size());
    return std::vector<target_shape<D>>(m.cells().size(), {all.inverse.front(), weight});
}

} // namespace taut::impl
