// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/impl/core/mesh/unused_vertices.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/impl/core/start/outline.hpp>
#include <taut/mesh.hpp>
#include <taut/parameterize.hpp>

namespace taut::impl
{

/// Validated surface of a run of parameterize(), with data shared by all phases. Lengths are those of the user times a
/// power of two (unit_scale), so that nothing overflows; undoing that is exact.
struct run_surface
{
    std::vector<idx> unused; ///< vertices without a triangle; they lie where another vertex does
    double unit;
    mesh<triangle> surface;
    facet_table sides;
    ideal_elements<triangle> ideal;

    /// Throws mesh_error, and parameter_error for data of another mesh.
    run_surface(const mesh<triangle>& m, const parameterize_params& params)
        : unused(unused_vertices(m.points().size(), m.cells())),
          unit(unit_scale(placed(m, unused))),
          surface(scaled(placed(m, unused), unit)),
          sides(checked(surface, !params.holes)),
          ideal(surface)
    {
        params.data.validate(m.cells().size());
        if (!params.polygons.empty() && params.polygons.size() != m.cells().size())
            throw parameter_error("polygons", "must have a number for each triangle, or none");
        if (std::any_of(params.polygons.begin(), params.polygons.end(), [](idx p) { return p < 0; }))
            throw parameter_error("polygons", "must be numbers from 0");
    }

    /// Vertices that keep their positions in the start.
    std::vector<idx> fixed_boundary(boundary_mode mode) const
    {
        if (mode == boundary_mode::free) return {};
        auto loops = boundary_loops(surface, sides);
        return std::move(loops[longest_loop(surface.points(), loops)]);
    }

    /// Moves unused vertices of a map to the position of another one, so that they have no effect.
    void set_unused_aside(std::vector<vec2>& uv) const { set_aside(std::span(unused), surface.cells(), uv); }

private:
    static mesh<triangle> placed(const mesh<triangle>& m, std::span<const idx> unused)
    {
        auto points = m.points();
        set_aside(unused, m.cells(), points);
        return {std::move(points), m.cells()};
    }

    static facet_table checked(const mesh<triangle>& m, bool one_boundary)
    {
        auto sides = facets(m);
        validate(m, sides, {.referenced = false, .one_boundary = one_boundary});
        return sides;
    }
};

} // namespace taut::impl
