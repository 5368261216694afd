// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/hierarchy/make_hierarchy.hpp>
#include <taut/impl/core/start/barycentric_map.hpp>
#include <taut/impl/core/start/isometric_newton.hpp>
#include <taut/impl/core/start/raise_map.hpp>
#include <taut/impl/core/start/tube_map.hpp>

namespace taut::impl
{

/// Parameters of an initial map of a small surface.
struct robust_start_params
{
    /// Outline of the initial barycentric map.
    boundary_params boundary = {};

    /// True if the boundary stays on that outline; the inside is optimised in any case.
    bool fixed_boundary = false;

    /// Relative decrease of the energy per iteration below which Newton's method ends on a level; 1e-6 to 1.
    double tolerance = 0.02;

    /// Isometric energy, as area mean, below which Newton's method ends on any level; 4 is an isometry.
    double enough = 4;

    int iterations = 50;  ///< maximum number of Newton iterations on each level; 0 to 1000
    unsigned threads = 0; ///< at most so many; 0: as many as the machine runs at once. The result does not change

    /// Callback before each iteration; returning false ends the run.
    std::function<bool()> proceed = {};

    /// Throws parameter_error with the name of a field outside its domain.
    void validate() const
    {
        if (!(tolerance >= 1e-6 && tolerance <= 1)) throw parameter_error("tolerance", "must be 1e-6 to 1");
        if (!(enough >= 0)) throw parameter_error("enough", "must not be negative");
        if (iterations < 0 || iterations > 1000) throw parameter_error("iterations", "must be 0 to 1000");
    }
};

/// Vertices of a level that a direct solver handles in fractions of a second.
constexpr std::size_t largest_direct = 20000;

/// One hierarchy to a coarsest surface and back.
struct descent_plan
{
    double factor;    ///< between levels
    idx min_vertices; ///< vertices of the coarsest level
    barycentric_weights weights;
};

/// Area of a level at rest.
inline double surface_area(const hierarchy<triangle>& h, std::size_t level, std::span<const vec3> points)
{
    const auto at = [&](idx v)
    { return points[static_cast<std::size_t>(h.levels[level].vertices[static_cast<std::size_t>(v)])]; };
    double sum = 0;
    for (const auto& t : h.levels[level].cells)
        sum += 0.5 * glm::length(glm::cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])));
    return sum;
}

/// Brings a map of a level on an outline, which has the area of the level, to the area of the whole surface.
inline void scale_outline(const hierarchy<triangle>& h, std::size_t level, std::span<const vec3> points,
                          std::vector<vec2>& uv)
{
    const double scale = std::sqrt(surface_area(h, 0, points) / surface_area(h, level, points));
    for (vec2& p : uv) p *= scale;
}

/// Newton's method on the isometric energy of a level, from a map without flips. Returns the energy, as area mean.
inline double optimize_level(const hierarchy<triangle>& h, std::size_t level, std::span<const vec3> rest,
                             std::span<const char> fixed, const robust_start_params& params, std::vector<vec2>& uv)
{
    std::vector<vec3> points;
    std::vector<char> here;
    for (const idx v : h.levels[level].vertices)
    {
        points.push_back(rest[static_cast<std::size_t>(v)]);
        here.push_back(fixed.empty() ? char(0) : fixed[static_cast<std::size_t>(v)]);
    }
    isometric_newton newton(points, h.levels[level].cells, here);
    double energy = newton.value(uv);
    for (int i = 0; i < params.iterations && std::isfinite(energy) && energy > params.enough; ++i)
    {
        if (params.proceed && !params.proceed()) break;
        const double before = std::exchange(energy, newton.step(uv, energy));
        if (!(energy < (1 - params.tolerance) * before)) break;
    }
    return energy;
}

/// Computes a map on a coarsest surface of a few vertices, then optimises and refines it alternately. A long tube that
/// would shrink below the resolution of numbers on the fine surface does not on the coarse one, and it is expanded
/// before the next vertices are reinserted.
inline start_map nested_start(const mesh<triangle>& m, const ideal_elements<triangle>& ideal,
                              std::span<const char> fixed, const descent_plan& plan, const robust_start_params& params)
{
    const auto h =
        make_hierarchy(m, fixed, {.factor = plan.factor, .min_vertices = plan.min_vertices, .threads = params.threads});
    const std::size_t coarsest = h.levels.size() - 1;
    const auto coarse = level_mesh(h, coarsest, m.points());
    start_map map = barycentric_map(coarse, facets(coarse), {.boundary = params.boundary, .weights = plan.weights});
    if (!fixed.empty()) scale_outline(h, coarsest, m.points(), map.uv);
    raise_params raise{.fixed = fixed, .threads = params.threads};
    for (std::size_t level = coarsest;; --level)
    {
        if (level < coarsest) map.uv = raise_map(h, level, m.points(), std::move(map.uv), raise).uv;
        optimize_level(h, level, m.points(), fixed, params, map.uv);
        if (level == 0) break;
    }
    if (fixed.empty()) scale_to_fit(h, 0, m.points(), map.uv);
    assess(map, m, ideal);
    return map;
}

/// Optimises the map of a long tube on concentric rings; without uv where the surface is none, or the limits ended it.
inline start_map tube_start(const mesh<triangle>& m, const ideal_elements<triangle>& ideal,
                            std::span<const std::vector<idx>> loops, const robust_start_params& params)
{
    start_map map;
    try
    {
        map.uv = tube_map(m, loops, params.proceed);
    }
    catch (const elimination_solver::stopped&)
    {
    }
    catch (const error&)
    {
        // What cannot be solved is no tube.
    }
    if (map.uv.empty()) return map;
    hierarchy<triangle> h;
    h.levels.push_back({std::vector<idx>(map.uv.size()), m.cells()});
    std::iota(h.levels[0].vertices.begin(), h.levels[0].vertices.end(), idx{0});
    assess(map, m, ideal);
    if (!map.flips) return map;
    optimize_level(h, 0, m.points(), {}, params, map.uv);
    scale_to_fit(h, 0, m.points(), map.uv);
    assess(map, m, ideal);
    return map;
}

/// Computes a map of low distortion of a small surface, valid on surfaces whose barycentric map is not: tubes a hundred
/// times as long as wide, closed bodies with a short slit.
///
/// The surface is coarsened to a few vertices, mapped there by a barycentric map, and refined level by level, with
/// Newton's method on the isometric energy on each (compare Shen, Jiang, Zorin, Panozzo 2019, "Progressive
/// embedding"). Should that fail, other hierarchies are tried, then the barycentric map itself; the best is returned.
///
/// m: a surface that has passed validate() with `one_boundary` false; 50 to some 1000 vertices are meant, as a direct
/// solver does the work (n^1.5). uv: in units of the surface, at the scale with the least energy; with a fixed boundary
/// on the outline, which has the area of the surface.
///
/// start_map::flips tells whether it is valid, exactly. Throws mesh_error (closed_surface, degenerate_cell),
/// parameter_error.
inline start_map robust_start(const mesh<triangle>& m, const robust_start_params& params = {})
{
    params.validate();
    const double unit = unit_scale(m);
    const mesh<triangle> surface = scaled(m, unit);
    const auto f = facets(surface);
    const auto loops = boundary_loops(surface, f);
    if (loops.empty())
        throw mesh_error(mesh_error::closed_surface, {}, "robust_start: the surface is closed; cut it open");
    const ideal_elements<triangle> ideal(surface);
    std::vector<char> fixed;
    if (params.fixed_boundary) fixed = boundary_flags(m.points().size(), loops);

    constexpr impl::descent_plan plans[] = {{4, 8, barycentric_weights::uniform},
                                            {2, 20, barycentric_weights::mean_value},
                                            {3, 5, barycentric_weights::uniform}};
    constexpr double moderate = 1e4; // isometric energy that any solver can begin with
    start_map best;
    best.flips.flipped = m.cells().size() + 1;
    const auto keep_better = [&](start_map&& map)
    {
        if (impl::better(map, best)) best = std::move(map);
        return best.flips && best.distortion.measure < moderate;
    };
    const auto proceed = [&] { return !params.proceed || params.proceed(); };
    bool done = false;
    for (const auto& plan : plans)
    {
        try
        {
            done = keep_better(impl::nested_start(surface, ideal, fixed, plan, params));
        }
        catch (const error&)
        {
            // A coarse surface without a barycentric map; the next plan ends elsewhere.
        }
        if (done || !proceed()) break;
    }
    for (const auto weights : {barycentric_weights::mean_value, barycentric_weights::uniform})
    {
        if (done || (!best.uv.empty() && !proceed())) break;
        try
        {
            done = keep_better(barycentric_map(surface, f,
                                               {.boundary = params.boundary, .weights = weights, .stretch_rounds = 10},
                                               {}, params.proceed));
        }
        catch (const error&)
        {
            // Weights of very different sizes may be too much for the solver; uniform ones are not.
            if (weights == barycentric_weights::uniform && best.uv.empty()) throw;
        }
    }
    best.outline = impl::longest_loop(surface.points(), loops);
    best.holes = loops.size() - 1;
    best.residual = 0;
    for (vec2& p : best.uv) p /= unit; // a power of two: exact
    return best;
}

} // namespace taut::impl
