// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/mesh/validate.hpp>
#include <taut/impl/core/sparse/elimination_solver.hpp>
#include <taut/impl/core/start/make_barycentric_system.hpp>
#include <taut/impl/core/start/outline.hpp>
#include <taut/impl/core/start/start_map.hpp>
#include <taut/mesh.hpp>
#include <taut/start_map.hpp>

namespace taut::impl
{

/// Largest residual of a row: the deviation of an unknown from the mean of its neighbours.
inline double mean_residual(const barycentric_system& system, std::span<const vec2> x)
{
    double largest = 0;
    for (std::size_t i = 0; i < system.size(); ++i)
    {
        vec2 sum = system.rhs[i];
        double total = system.excess[i];
        for (auto k = static_cast<std::size_t>(system.offset[i]); k < static_cast<std::size_t>(system.offset[i + 1]);
             ++k)
        {
            sum += system.weight[k] * x[static_cast<std::size_t>(system.column[k])];
            total += system.weight[k];
        }
        largest = std::max(largest, glm::length(x[i] - sum / total));
    }
    return largest;
}

/// Divides each vertex' pull by the stretch of the map back to the surface around it: where the image is too small, it
/// grows. Weights stay positive, so the map stays injective (Yoshizawa, Belyaev, Seidel 2004). The stretch is the root
/// of the area mean of |S|^2 / (2 det^2) over the triangles of the vertex.
inline void weaken_stretched(std::span<double> pull, const mesh<triangle>& m, const ideal_elements<triangle>& ideal,
                             std::span<const vec2> uv)
{
    constexpr double collapsed = 1e-30; // below, det is rounding
    std::vector<double> stretch2(pull.size(), 0);
    std::vector<double> area(pull.size(), 0);
    for (std::size_t c = 0; c < m.cells().size(); ++c)
    {
        const auto e = mapped_element(m, ideal, uv, c);
        const double det = std::max(std::abs(e.det), collapsed);
        const double s2 = std::max(norm2(e.S) / 2, collapsed) / (det * det);
        for (const idx v : m.cells()[c])
        {
            stretch2[static_cast<std::size_t>(v)] += s2 * e.measure;
            area[static_cast<std::size_t>(v)] += e.measure;
        }
    }
    for (std::size_t v = 0; v < pull.size(); ++v)
        if (area[v] > 0) pull[v] /= std::sqrt(stretch2[v] / area[v]);
}

/// True if `a` is a better start than `b`: fewer defects, then less distortion by the given factor.
inline bool better(const start_map& a, const start_map& b, double factor = 1)
{
    if (a.flips.defects() != b.flips.defects()) return a.flips.defects() < b.flips.defects();
    return a.distortion.measure < factor * b.distortion.measure;
}

/// Solves the system of a round. False if the solver stopped, but for the first round, which has no map before it.
template <class Solver>
bool solve_round(Solver& solver, const barycentric_system& system, int round, std::vector<vec2>& x)
{
    try
    {
        x = solver(system);
    }
    catch (const elimination_solver::stopped&)
    {
        if (round == 0) throw;
        return false;
    }
    return true;
}

/// Barycentric map of a surface that has passed validate() with `one_boundary` false: the longest boundary loop on a
/// convex polygon, every other vertex at a positive mean of its neighbours. Injective in exact arithmetic (Tutte 1963,
/// Floater 2003); in rounded arithmetic it is checked, and start_map::flips is what the check found.
///
/// The polygon is centred at the origin, counter-clockwise, with the area of the surface. Further loops are holes: each
/// is spanned by a cone whose apex is solved for as well, so that the theorem holds, and then dropped.
/// f: facets(m). solver: a callable std::vector<vec2>(const barycentric_system&). One that stops ends with the map of
/// the round before; without one, elimination_solver::stopped passes through. Throws mesh_error (closed_surface,
/// degenerate_cell), parameter_error, `error` (weights, solver).
template <class Solver = elimination_solver>
start_map barycentric_map(const mesh<triangle>& m, const facet_table& f, const barycentric_params& params,
                          Solver solver = {}, const std::function<bool()>& proceed = {})
{
    const auto loops = boundary_loops(m, f);
    if (loops.empty())
        throw mesh_error(mesh_error::closed_surface, {}, "barycentric_map: the surface is closed; cut it open");
    if (params.stretch_rounds < 0 || params.stretch_rounds > 20)
        throw parameter_error("stretch_rounds", "must be 0 to 20");
    // Everything is computed in units of the model: squares of lengths neither overflow nor vanish.
    const double unit = unit_scale(m);
    const ideal_elements<triangle> ideal(m, unit);
    auto points = m.points();
    for (auto& p : points) p *= unit;
    auto cells = m.cells();

    start_map next;
    next.outline = impl::longest_loop(points, loops);
    next.holes = loops.size() - 1;
    const auto& outline = loops[next.outline];
    double area = 0;
    for (const double a : ideal.measure) area += a;
    std::vector<vec3> rim;
    for (const idx v : outline) rim.push_back(points[static_cast<std::size_t>(v)]);
    const auto polygon = boundary_polygon(rim, params.boundary, area, impl::dividing_edges(m, f, outline));
    for (std::size_t l = 0; l < loops.size(); ++l)
        if (l != next.outline) impl::span_hole(loops[l], points, cells);

    std::vector<char> fixed(points.size(), 0);
    next.uv.assign(points.size(), vec2(0));
    for (std::size_t k = 0; k < outline.size(); ++k)
    {
        fixed[static_cast<std::size_t>(outline[k])] = 1;
        next.uv[static_cast<std::size_t>(outline[k])] = polygon[k];
    }
    std::vector<double> pull(points.size(), 1.0);
    start_map result;
    for (int round = 0; round <= params.stretch_rounds; ++round)
    {
        if (round > 0 && proceed && !proceed()) break;
        if (round > 0) impl::weaken_stretched(pull, m, ideal, next.uv);
        const auto system = make_barycentric_system(points, cells, fixed, next.uv, params.weights, pull);
        std::vector<vec2> x;
        if (!impl::solve_round(solver, system, round, x)) break;
        for (std::size_t i = 0; i < x.size(); ++i) next.uv[static_cast<std::size_t>(system.unknown[i])] = x[i];
        next.residual = impl::mean_residual(system, x) / std::sqrt(area);
        assess(next, m, ideal);
        const bool gains = round == 0 || impl::better(next, result, 0.95);
        if (round == 0 || impl::better(next, result)) result = next;
        if (!gains) break;
    }
    result.uv.resize(m.points().size());
    for (auto& p : result.uv) p /= unit; // a power of two: exact
    return result;
}

/// The same with the mesh validated first. Throws mesh_error with every kind of fault that validate() knows, but for
/// several boundary loops.
template <class Solver = elimination_solver>
start_map barycentric_map(const mesh<triangle>& m, const barycentric_params& params = {}, Solver solver = {})
{
    const auto f = facets(m);
    validate(m, f, {.referenced = false, .one_boundary = false});
    return barycentric_map(m, f, params, std::move(solver));
}

// Compiled once, with the bodies.
extern template start_map barycentric_map<elimination_solver>(const mesh<triangle>&, const facet_table&,
                                                              const barycentric_params&, elimination_solver,
                                                              const std::function<bool()>&);

} // namespace taut::impl
