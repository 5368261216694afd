// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <taut/impl/core/start/robust.hpp>

namespace taut::impl
{

/// Parameters of an initial map through a hierarchy.
struct coarse_start_params
{
    /// Maximum number of vertices of the level that robust_start() works on; at least 3.
    idx vertices = 1000;

    robust_start_params coarse = {};

    /// Throws parameter_error with the name of a field outside its domain.
    void validate() const
    {
        if (vertices < 3) throw parameter_error("vertices", "must be at least 3");
        coarse.validate();
    }
};

/// Computes a map of low distortion without a linear solve on the fine surface: robust_start() on a coarse level, then
/// reinsertion of the vertices level by level. Linear time beyond that level, about 1 us per triangle on one core.
///
/// m: a surface that has passed validate() with `one_boundary` false. h: its hierarchy; with a fixed boundary all
/// boundary vertices were kept. uv: as of robust_start().
/// start_map::flips tells whether it is valid, exactly. Throws mesh_error (closed_surface, degenerate_cell),
/// parameter_error (also where the hierarchy is of another surface, or without the fixed boundary).
inline start_map coarse_start(const mesh<triangle>& m, const hierarchy<triangle>& h,
                              const coarse_start_params& params = {})
{
    params.validate();
    if (h.levels[0].vertices.size() != m.points().size()) throw parameter_error("h", "must be of the same surface");
    std::size_t level = 0;
    while (level + 1 < h.levels.size() && h.levels[level].vertices.size() > static_cast<std::size_t>(params.vertices))
        ++level;

    const double unit = unit_scale(m);
    auto points = m.points();
    for (vec3& p : points) p *= unit;
    const ideal_elements<triangle> ideal(m, unit);
    start_map map = robust_start(level_mesh(h, level, points), params.coarse);
    std::vector<char> fixed;
    std::vector<std::vector<idx>> loops;
    if (params.coarse.fixed_boundary || map.holes > 0) loops = boundary_loops(m, facets(m));
    if (map.holes > 0) map.outline = impl::longest_loop(points, loops); // the level may number them otherwise
    if (params.coarse.fixed_boundary)
    {
        fixed = boundary_flags(points.size(), loops);
        auto lost = std::count(fixed.begin(), fixed.end(), 1);
        for (const idx v : h.levels[level].vertices) lost -= fixed[static_cast<std::size_t>(v)];
        if (lost != 0) throw parameter_error("h", "must keep the boundary, which is to be fixed");
        impl::scale_outline(h, level, points, map.uv);
    }
    double energy = map.distortion.measure;
    while (level-- > 0)
    {
        auto finer =
            impl::raise_map(h, level, points, std::move(map.uv), {.fixed = fixed, .threads = params.coarse.threads});
        map.uv = std::move(finer.uv);
        double raised = finer.energy.after;
        // The next level would only make it worse; while a direct solver can, it is put right here.
        if (raised > 2 * energy && map.uv.size() <= impl::largest_direct)
            raised = impl::optimize_level(h, level, points, fixed, params.coarse, map.uv);
        energy = raised;
    }
    if (fixed.empty()) impl::scale_to_fit(h, 0, points, map.uv);
    assess(map, m, ideal);
    for (vec2& p : map.uv) p /= unit; // a power of two: exact
    return map;
}

} // namespace taut::impl
