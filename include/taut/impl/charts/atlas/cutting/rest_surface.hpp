// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/seams/seam_arcs.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// A surface at rest with what cutting asks of it again and again. Side s = 3 c + k of triangle c lies opposite its
/// corner k, and runs from corner k + 1 to corner k + 2; corners are numbered as sides.
struct rest_surface
{
    mesh<triangle> surface;
    facet_table facets;
    csr sides;                  ///< that start at each vertex: one of each of its triangles
    std::vector<double> length; ///< one a side
    std::vector<double> price;  ///< what a seam along each side counts: its length, times a wish
    std::vector<double> area;   ///< one a triangle
    std::vector<double> weight; ///< one a triangle, of its energy: the area, but little where it spans a hole
    std::vector<mat2> inverse;  ///< one a triangle: inverse of its ideal edge matrix
    std::vector<char> rim;      ///< one a vertex: whether it lies on the boundary
    idx first_span = 0;         ///< triangles from there on span holes
    double total = 0;           ///< area without these

    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }
    static idx next(idx side) { return side % 3 == 2 ? side - 2 : side + 1; }
    static idx last(idx side) { return side % 3 == 0 ? side + 2 : side - 1; }

    /// The corners at the ends of a side.
    static idx start_corner(idx side) { return next(side); }
    static idx end_corner(idx side) { return last(side); }

    idx vertex(idx corner) const { return surface.cells()[u(corner / 3)][u(corner % 3)]; }
    idx start(idx side) const { return vertex(start_corner(side)); }
    idx end(idx side) const { return vertex(end_corner(side)); }
    idx twin(idx side) const { return facets.twin[u(side)]; }
    idx vertices() const { return surface.vertex_count(); }
    idx triangles() const { return surface.cell_count(); }

    /// first_span: triangles from there on span holes. Lengths of any unit; the mesh is an oriented manifold.
    static rest_surface of(mesh<triangle> m, idx first_span)
    {
        rest_surface r{.surface = std::move(m),
                       .facets = {},
                       .sides = {},
                       .length = {},
                       .price = {},
                       .area = {},
                       .weight = {},
                       .inverse = {},
                       .rim = {},
                       .first_span = first_span};
        r.facets = taut::impl::facets(r.surface);
        r.sides = starting_sides(r.surface);
        r.rim.assign(r.surface.points().size(), 0);
        for (idx c = 0; c < r.triangles(); ++c)
        {
            const auto x = r.surface.rest(c);
            const mat2 W = stiff_ideal(x[1] - x[0], x[2] - x[0]);
            r.inverse.push_back(invert_upper(W));
            r.area.push_back(0.5 * W[0][0] * W[1][1]);
            constexpr double little = 1e-3; // enough to keep what spans a hole from becoming flat
            r.weight.push_back(c < first_span ? r.area.back() : little * r.area.back());
            if (c < first_span) r.total += r.area.back();
            for (idx s = 3 * c; s < 3 * c + 3; ++s)
            {
                r.length.push_back(glm::distance(x[u((s + 1) % 3)], x[u((s + 2) % 3)]));
                if (r.twin(s) < 0) r.rim[u(r.start(s))] = r.rim[u(r.end(s))] = 1;
            }
        }
        r.price = r.length;
        return r;
    }
};

} // namespace taut::impl
