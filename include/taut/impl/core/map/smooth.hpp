// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/energies.hpp>
#include <taut/impl/core/constrain/boundary_slides.hpp>
#include <taut/smooth.hpp>

namespace taut::impl
{

/// Points times 2^by, exactly.
template <class Point>
std::vector<Point> times_power(std::vector<Point> points, int by)
{
    for (Point& p : points)
        for (int k = 0; k < Point::length(); ++k) p[k] = std::ldexp(p[k], by);
    return points;
}

/// Exponent of 2 of the largest coordinate: shapes have no size, so a mesh of any size is one of about 1.
inline int size_exponent(std::span<const vec3> points)
{
    double most = 0;
    for (const vec3& p : points)
        for (int k = 0; k < 3; ++k) most = std::max(most, std::abs(p[k]));
    return most > 0 && std::isfinite(most) ? std::ilogb(most) : 0;
}

/// An observer of the mesh divided by 2^exponent that tells coordinates of the mesh itself. ask is referred to.
template <class Element>
observer in_own_size(const observer& ask, int exponent)
{
    if (!ask) return {};
    return [&ask, exponent](progress p)
    {
        const auto restore = [&](auto& seen)
        {
            if (seen) seen = [inner = seen, exponent] { return times_power(inner(), exponent); };
        };
        if constexpr (Element::dimension == 2)
            restore(p.coordinates);
        else
            restore(p.positions);
        return ask(p);
    };
}

/// The deformation that smooths a mesh, given divided by 2^exponent, but for what moves how.
template <class Element>
deform_params<Element> smoothing(const smooth_params<Element>& params, int exponent)
{
    deform_params<Element> how;
    how.energy = energy::shape_power{params.worst_exponent};
    how.weights = energy::weighting::uniform;
    how.regular = params.rest.empty();
    how.targets = params.targets;
    if (!how.regular)
        for (auto& edges : how.targets)
            for (int k = 0; k < Element::dimension; ++k)
                for (int r = 0; r < Element::dimension; ++r) edges[k][r] = std::ldexp(edges[k][r], -exponent);
    how.owners = params.owners;
    how.precision = params.precision;
    how.solve = params.solve;
    return how;
}

/// Flags of the vertices that smoothing fixes. Throws constraint_error.
template <class Element>
std::vector<char> still_vertices(const mesh<Element>& m, const smooth_params<Element>& params)
{
    std::vector<char> still(m.points().size(), 0);
    for (const idx v : params.fixed)
        if (v >= 0 && v < m.vertex_count())
            still[static_cast<std::size_t>(v)] = 1;
        else
            throw constraint_error(constraint_error::out_of_range, {v},
                                   "fixed vertex " + std::to_string(v) + " of a mesh that has " +
                                       std::to_string(m.vertex_count()) + ", counted from 0");
    if (params.boundary == smooth_boundary::fixed)
        for (const auto& facet : boundary_facets(m, params.owners))
            for (const idx v : facet) still[static_cast<std::size_t>(v)] = 1;
    return still;
}

/// Pins and slides of a mesh that is smoothed.
template <class Element>
void constrain_smoothing(deform_params<Element>& how, const mesh<Element>& m, const smooth_params<Element>& params)
{
    kept_directions<Element> directions(m);
    if (params.boundary == smooth_boundary::sliding) directions.add(boundary_facets(m, params.owners));
    directions.add(params.kept);
    auto motion = directions.motion();
    const auto still = still_vertices(m, params);
    for (std::size_t v = 0; v < still.size(); ++v)
        if (still[v]) motion.pins.repin(static_cast<idx>(v), vec<Element::dimension>(m.points()[v]));
    std::erase_if(motion.slides, [&](const auto& s) { return still[static_cast<std::size_t>(s.vertex)] != 0; });
    how.constraints = std::move(motion.pins);
    how.slides = std::move(motion.slides);
}

} // namespace taut::impl
