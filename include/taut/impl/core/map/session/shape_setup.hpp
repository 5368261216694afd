// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <taut/deform.hpp>
#include <taut/errors.hpp>
#include <taut/impl/core/constrain/constraint_error.hpp>
#include <taut/impl/core/map/session/session_setup.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>
#include <taut/session.hpp>
#include <taut/shell.hpp>

namespace taut::impl
{

/// Validates a mesh that deforms, which may have any number of components, holes and handles; vertices without cells
/// keep their positions. Throws mesh_error, and parameter_error for parameters that are not of this mesh.
template <class Element>
void require_deformable(const mesh<Element>& m, const deform_params<Element>& params)
{
    constexpr int D = Element::dimension;
    for (const auto& [size, field] : {std::pair{params.targets.size(), "targets"}, {params.owners.size(), "owners"}})
        if (size != 0 && size != m.cells().size())
            throw parameter_error(field, std::to_string(size) + " for " + std::to_string(m.cells().size()) + " cells");
    auto found =
        check(m, {.referenced = false, .connected = false, .open = false, .one_boundary = false, .no_handles = false});
    if (params.regular) // which need no rest shape
        std::erase_if(found, [](const mesh_finding& f)
                      { return f.fault == mesh_error::degenerate_cell || f.fault == mesh_error::inverted_cell; });
    if constexpr (D == 3) // its hierarchy knows no facets
        std::erase_if(found, [](const mesh_finding& f) { return f.fault == mesh_error::non_manifold_vertex; });
    if (!params.owners.empty()) // which share facets
        std::erase_if(found, [](const mesh_finding& f)
                      { return f.fault != mesh_error::degenerate_cell && f.fault != mesh_error::inverted_cell; });
    if (!found.empty()) throw mesh_error(describe<Element>(found[0].fault, found[0].ids, params.owners));
    if constexpr (D == 2)
        if (!is_planar(m.points()))
            throw parameter_error("mesh", "a surface in space has no shape in the plane; parameterize it");
}

/// Measure of all cells, inverted or not.
template <class Element>
double whole_measure(const mesh<Element>& m)
{
    constexpr int D = Element::dimension;
    double total = 0;
    for (idx c = 0; c < m.cell_count(); ++c)
    {
        const auto rest = m.rest(c);
        typename Element::mapped_corners x;
        for (std::size_t k = 0; k < x.size(); ++k) x[k] = vec<D>(rest[k]);
        total += std::abs(Element::determinant(x)) * Element::measure_factor;
    }
    return total;
}

/// Target shapes of a mesh that deforms. unit: normalised unit by that of the parameters.
template <class Element>
ideal_elements<Element> target_elements(const mesh<Element>& m, const deform_params<Element>& params, double unit)
{
    constexpr int D = Element::dimension;
    if constexpr (!Element::oriented)
        return ideal_elements<Element>(m);
    else
    {
        if (params.targets.empty())
            return params.regular ? regular_elements<Element>(m.cells().size(), whole_measure(m))
                                  : ideal_elements<Element>(m);
        auto wanted = elements_with_edges<Element>(params.targets, unit, "targets");
        if (!params.regular) return wanted;
        const double factor = whole_measure(m) / std::accumulate(wanted.measure.begin(), wanted.measure.end(), 0.0);
        for (auto& inverse : wanted.inverse) inverse /= std::pow(factor, 1.0 / D);
        for (double& measure : wanted.measure) measure *= factor;
        return wanted;
    }
}

/// Sets up the session of a deforming shape. Throws mesh_error, parameter_error, constraint_error.
template <class Element>
session_setup<Element> shape_setup(const mesh<Element>& m, const deform_params<Element>& given,
                                   const run_limits& limits)
{
    constexpr int D = Element::dimension;
    auto params = validated(given);
    limits.validate();
    const double unit = unit_scale(m);
    if (const std::size_t count = params.initial.size(), n = m.points().size(); count != 0 && count != n)
        throw parameter_error("initial", std::to_string(count) + " positions for " + std::to_string(n) + " vertices");
    auto points = m.points();
    for (vec3& p : points) p *= unit;
    mesh<Element> rest(std::move(points), m.cells());
    params.data.validate(rest.cells().size());
    if constexpr (Element::oriented) require_deformable(rest, params); // a thin_shell is so
    auto ideal = target_elements(rest, params, unit);
    std::vector<idx> bad;
    for (const auto& s : params.slides)
        if (s.vertex < 0 || s.vertex >= rest.vertex_count() || params.constraints.held(s.vertex) != 0)
            bad.push_back(s.vertex);
    refuse_vertices(constraint_error::contradictory, std::move(bad),
                    "that the mesh does not have, or that is pinned, among the slides; leave it out");
    params.constraints.on(rest).require_near(unit);

    std::vector<mat<D>> targets;
    if (Element::oriented && params.regular)
        for (const auto& inverse : ideal.inverse) targets.push_back(invert_upper(inverse));
    std::vector<vec<D>> start = std::move(params.initial);
    if (start.empty()) start.assign(m.points().begin(), m.points().end());
    return {.of = {.rest = std::move(rest),
                   .ideal = std::move(ideal),
                   .energy = std::move(params.energy),
                   .weights = params.weights,
                   .data = std::move(params.data),
                   .targets = std::move(targets),
                   .owners = std::move(params.owners),
                   .unit = unit},
            .constraints = std::move(params.constraints),
            .slides = std::move(params.slides),
            .start = std::move(start),
            .precision = params.precision,
            .solve = params.solve,
            .limits = limits};
}

/// Sets up the session of a thin shell: a shape of hinges, certified by the triangles of the surface.
inline session_setup<hinge> shell_setup(const thin_shell& shell, const shell_params& params, const run_limits& limits)
{
    params.validate();
    auto setup = shape_setup<hinge>(
        shell.hinges(),
        {.energy = {energy::shell{}, {params.thickness ? *params.thickness / shell.mean_edge() : 1.0}},
         .weights = energy::weighting::uniform,
         .data = shell.rest(),
         .constraints = params.constraints,
         .initial = params.initial,
         .precision = params.precision,
         .solve = params.solve},
        limits);
    setup.of.surface = shell.surface();
    return setup;
}

// Compiled once, with the bodies.
extern template session_setup<triangle> shape_setup(const mesh<triangle>&, const deform_params<triangle>&,
                                                    const run_limits&);

} // namespace taut::impl
