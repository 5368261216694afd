// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/constrain/boundary_slides.hpp>
#include <taut/impl/constrain/smooth_boundary.hpp>
#include <taut/impl/energy/shape_power.hpp>
#include <taut/impl/map/deform.hpp>
#include <taut/impl/measure/shape_quality.hpp>

namespace taut
{

/// Parameters of smooth(). Every field has a sensible default.
template <class Element>
struct smooth_params
{
    smooth_boundary boundary = smooth_boundary::sliding;

    /// Shape whose elements are the target shapes, one position per vertex; empty: regular elements are.
    std::vector<vec3> rest = {};

    /// Target shapes of single elements, and their owners, as in deform_params: those of corner_simplices::regular
    /// where they are corners of regular cells.
    std::vector<mat<Element::dimension>> targets = {};
    std::vector<idx> owners = {};

    /// Power of the energy, which is shape distortion: larger ones improve the worst elements first, 1 the mean. Range
    /// 1 to 8.
    int worst_exponent = 2;

    /// Vertices that are fixed, whatever smooth_params::boundary says.
    std::vector<idx> fixed = {};

    /// Facets, inside or on the boundary, of surfaces that keep their shape whatever the boundary does: interfaces
    /// between materials, named pieces of the boundary (io::volume_file::kept_facets() finds them). Flat pieces slide
    /// in their planes, straight lines where pieces meet or end along themselves; curved parts are fixed.
    std::vector<impl::kept_facet> kept = {};

    taut::precision precision = precision::automatic;
    solve::params solve = {.gradient_tolerance = 1e-4};

    /// Throws parameter_error that names the field; deform_params says the rest.
    void validate() const
    {
        if (worst_exponent < 1 || worst_exponent > 8) throw parameter_error("worst_exponent", "must be 1 to 8");
    }
};

/// Result of smooth(): positions, a report, and the qualities of the elements before and after; `auto [x, report,
/// before, after] = smooth(...)`.
template <class Element>
struct smooth_result
{
    std::vector<vec<Element::dimension>> x; ///< one per vertex, in the user's order and lengths
    session_report report;
    impl::shape_quality before, after; ///< after: only with coordinates

    /// True if the mesh is certified: no element is inverted.
    explicit operator bool() const { return report.outcome == outcome::valid; }
};

} // namespace taut

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

namespace taut
{

/// Moves the vertices of a volume, or a mesh of the plane (z = 0), to improve the shapes of its elements, without
/// inverting one; inverted elements are untangled first. Connectivity is kept.
/// Throws mesh_error, parameter_error, constraint_error for wrong ids, device_error.
template <class Element>
smooth_result<Element> smooth(queue& q, const mesh<Element>& given, const smooth_params<Element>& params = {},
                              const run_limits& limits = {})
{
    params.validate();
    limits.validate();
    if (!params.owners.empty() && params.targets.size() != given.cells().size())
        throw parameter_error("targets", "one matrix a cell where there are owners");
    if (!params.rest.empty() && params.rest.size() != given.points().size())
        throw parameter_error("rest", std::to_string(params.rest.size()) + " positions for " +
                                          std::to_string(given.points().size()) + " vertices");
    using point = vec<Element::dimension>;
    const int exponent = impl::size_exponent(given.points());
    const mesh<Element> m(impl::times_power(given.points(), -exponent), given.cells());
    auto how = impl::smoothing(params, exponent);
    impl::constrain_smoothing(how, m, params);

    const std::vector<point> start(m.points().begin(), m.points().end());
    smooth_result<Element> result;
    const auto measured = [&](std::span<const point> x)
    {
        return params.owners.empty() ? measure_shapes<Element>(m.cells(), x)
                                     : measure_shapes<Element>(m.cells(), x, params.owners, params.targets);
    };
    result.before = measured(start);
    std::optional<mesh<Element>> other; // at rest, which starts as m
    if (!params.rest.empty())
    {
        other.emplace(impl::times_power(params.rest, -exponent), m.cells());
        how.initial = start;
    }
    auto found =
        deform(q, other ? *other : m, how, {limits.time_limit, impl::in_own_size<Element>(limits.observer, exponent)});
    if (!found.x.empty()) result.after = measured(found.x);
    auto& report = found.report;
    if (report.outcome == outcome::valid)
    {
        // Where rounding ends steps, what they came to may be worse than what was given.
        const bool worse = result.after.worst.mean_ratio < result.before.worst.mean_ratio &&
                           result.after.mean_ratio < result.before.mean_ratio;
        if (worse && !report.converged)
        {
            auto flips = certify<Element::dimension>(m.cells(), std::span<const point>(start), {}, 16, params.owners);
            if (flips)
            {
                found.x = start;
                result.after = result.before;
                report.flips = std::move(flips);
                report.notes.push_back("steps made the mesh worse; it stays as it was");
            }
        }
        if (!report.converged && !report.stopped)
            report.notes.push_back("steps ended before convergence; the result is the best by then");
    }
    result.x = impl::times_power(std::move(found.x), exponent);
    result.report = std::move(found.report);
    result.report.distance = std::ldexp(result.report.distance, exponent);
    return result;
}

} // namespace taut
