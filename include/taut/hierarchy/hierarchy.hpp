// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <taut/hierarchy/detail/thinning.hpp>
#include <taut/mesh/ideal.hpp>

namespace taut
{

/// How to build a hierarchy.
struct hierarchy_params
{
    double factor = 8;     ///< vertices of a level / vertices of the next coarser one; 2 to 64
    idx min_vertices = 50; ///< of the coarsest level, about; at least 3
    unsigned threads = 0;  ///< at most so many; 0: as many as the machine runs at once. The result does not change

    /// Asked between rounds of thinning: go on? Once it says no, no further level is made.
    std::function<bool()> proceed = {};

    /// Throws parameter_error with the name of a field outside its domain.
    void validate() const
    {
        if (!(factor >= 2 && factor <= 64)) throw parameter_error("factor", "must be 2 to 64");
        if (min_vertices < 3) throw parameter_error("min_vertices", "must be at least 3");
    }
};

/// A coarser and coarser surface on fewer and fewer of the vertices, with the way back: what multigrid and
/// coarse-to-fine methods work on. It holds connectivity and weights, no positions, so it serves any energy, any pins
/// that were kept, and other frames of the same mesh.
struct hierarchy
{
    struct level
    {
        std::vector<idx> vertices;             ///< numbers in the mesh, ascending
        std::vector<std::array<idx, 3>> cells; ///< oriented like the mesh; numbers in `vertices`
    };
    /// Between a level and the next coarser one.
    struct step
    {
        prolongation interpolation; ///< from the coarser to the finer level
        removals removed;           ///< how the finer level was thinned
    };

    std::vector<level> levels; ///< finest first; level 0 is the mesh itself
    std::vector<step> steps;   ///< steps[l] is between levels l and l + 1
};

/// Builds the hierarchy of an oriented surface, with or without boundary, holes and handles. Each level has the same
/// topology. Boundary vertices are pulled along the boundary only. Vertices without triangles have no part in it.
///
/// keep: one flag a vertex, or none at all. Kept vertices (pins, a fixed boundary) are on every level, and no triangle
///       is made whose three corners are all kept: it could not be repaired where they are pinned
///
/// A surface that cannot be thinned has one level. Linear time, about 1 us a triangle on two cores; the result takes 70
/// bytes a triangle, 160 while it is built.
/// Throws mesh_error (non_manifold_vertex) if the triangles of a vertex do not form one oriented fan, parameter_error.
inline hierarchy make_hierarchy(const mesh<triangle>& m, std::span<const char> keep = {},
                                const hierarchy_params& params = {})
{
    params.validate();
    const std::size_t n = m.points().size();
    if (!keep.empty() && keep.size() != n) throw parameter_error("keep", "must have one flag a vertex, or none");

    hierarchy h;
    h.levels.push_back({std::vector<idx>(n), m.cells()});
    std::iota(h.levels[0].vertices.begin(), h.levels[0].vertices.end(), 0);
    detail::thinning_surface surface;
    // In units of the model, so that no square leaves the range of numbers; a power of two changes no decision.
    surface.points = m.points();
    const double unit = unit_scale(m);
    for (vec3& p : surface.points) p *= unit;
    surface.keep.assign(n, 0);
    std::copy(keep.begin(), keep.end(), surface.keep.begin());
    surface.rings = detail::make_rings(m.cells(), n, surface.open, params.threads);

    for (;;)
    {
        detail::thinning work(std::move(surface), params.threads);
        const double size = static_cast<double>(work.alive()), least = params.min_vertices;
        if (!(size > 1.5 * least)) break;
        work.run(static_cast<std::size_t>(std::lround(std::max(size / params.factor, least))), params.proceed);
        if (params.proceed && !params.proceed()) break;
        if (static_cast<double>(work.alive()) > 0.8 * size) break; // another level would cost more than it helps

        surface = work.coarse();
        std::vector<idx> vertices;
        for (const idx v : work.remaining()) vertices.push_back(h.levels.back().vertices[static_cast<std::size_t>(v)]);
        h.levels.push_back({std::move(vertices), detail::ring_cells(surface.rings, surface.open)});
        auto [interpolation, removed] = work.result();
        h.steps.push_back({std::move(interpolation), std::move(removed)});
    }
    return h;
}

/// A level as a mesh of its own. points: rest positions of the vertices of the finest level, in this or another frame.
inline mesh<triangle> level_mesh(const hierarchy& h, std::size_t level, std::span<const vec3> points)
{
    std::vector<vec3> chosen;
    for (const idx v : h.levels[level].vertices) chosen.push_back(points[static_cast<std::size_t>(v)]);
    return {std::move(chosen), h.levels[level].cells};
}

} // namespace taut
