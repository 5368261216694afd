// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include <taut/impl/core/start/coarse_start.hpp>

namespace taut::impl
{

/// Parameters of a conformal map.
struct conformal_start_params
{
    /// Iterations of the eigenvector: 1 to 50. A few suffice.
    int iterations = 6;

    /// Parameters of the map that replaces a conformal one with flipped triangles. It has a free boundary.
    coarse_start_params fallback = {};

    /// Throws parameter_error with the name of a field outside its domain.
    void validate() const
    {
        if (iterations < 1 || iterations > 50) throw parameter_error("iterations", "must be 1 to 50");
        if (fallback.coarse.fixed_boundary) throw parameter_error("fixed_boundary", "a conformal map has a free one");
        fallback.validate();
    }
};

/// Conformal energy of each triangle, its area times the squared length of the part of S that is not a similarity, as a
/// quadratic form of its corners.
inline std::vector<front_cholesky::block> conformal_blocks(const ideal_elements<triangle>& ideal)
{
    std::vector<front_cholesky::block> blocks(ideal.inverse.size());
    for (std::size_t c = 0; c < blocks.size(); ++c)
    {
        const mat2& w = ideal.inverse[c];
        const std::array<vec2, 3> shape{vec2(-w[0][0] - w[0][1], -w[1][0] - w[1][1]), vec2(w[0][0], w[1][0]),
                                        vec2(w[0][1], w[1][1])};
        // S00 - S11 and S10 + S01 of the corners' coordinates.
        std::array<double, 6> difference{}, sum{};
        for (std::size_t k = 0; k < 3; ++k)
        {
            difference[2 * k] = sum[2 * k + 1] = shape[k].x;
            difference[2 * k + 1] = -shape[k].y;
            sum[2 * k] = shape[k].y;
        }
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t j = 0; j < 6; ++j)
                blocks[c][i][j] = ideal.measure[c] * (difference[i] * difference[j] + sum[i] * sum[j]);
    }
    return blocks;
}

/// Computes the map of minimum conformal energy among those whose boundary has a given moment of inertia: the
/// eigenvector to the smallest eigenvalue that is not a translation, by inverse iteration (Mullen, Tong, Alliez,
/// Desbrun 2008, "Spectral conformal parameterization"). It needs no pinned vertices, whose choice would show. It may
/// flip triangles.
inline std::vector<vec2> spectral_conformal_map(const mesh<triangle>& m, const ideal_elements<triangle>& ideal,
                                                std::span<const idx> outline, int iterations)
{
    const auto u = [](idx v) { return static_cast<std::size_t>(v); };
    const std::vector<char> fixed(m.points().size(), 0);
    front_cholesky solver(m.cells(), fixed);
    solver.factorize(conformal_blocks(ideal), 1e-11); // translations cost nothing: the shift keeps it regular

    std::vector<double> mass(m.points().size(), 0);
    std::vector<vec2> x(m.points().size(), vec2(0.0));
    double total = 0;
    for (std::size_t k = 0; k < outline.size(); ++k)
    {
        const idx a = outline[k], b = outline[(k + 1) % outline.size()];
        const double length = glm::distance(m.points()[u(a)], m.points()[u(b)]);
        mass[u(a)] += length / 2;
        mass[u(b)] += length / 2;
        total += length;
        const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(outline.size());
        x[u(a)] = {std::cos(angle), std::sin(angle)};
    }
    const auto centre = [&]
    {
        vec2 mean(0.0);
        for (const idx v : outline) mean += mass[u(v)] / total * x[u(v)];
        for (vec2& p : x) p -= mean;
    };
    for (int i = 0; i < iterations; ++i)
    {
        centre();
        double inertia = 0;
        for (const idx v : outline) inertia += mass[u(v)] * glm::dot(x[u(v)], x[u(v)]);
        std::vector<vec2> right(x.size(), vec2(0.0));
        for (const idx v : outline) right[u(v)] = mass[u(v)] / std::sqrt(inertia) * x[u(v)];
        x = solver.solve(right);
    }
    centre();
    return x;
}

/// Computes a conformal map with a free boundary by a linear eigenproblem. Where it has flipped triangles,
/// coarse_start() of the surface instead, so that the result is valid in either case; start_map::flips tells, exactly.
///
/// A start of little angular distortion. Its isometric energy is lowest only on developable surfaces; elsewhere that of
/// coarse_start() is lower, mostly several times, and found sooner, as this one takes a direct solver (n^1.5).
///
/// m: a surface that has passed validate() with `one_boundary` false; f: its facets. uv: in units of the surface, at
/// the scale with the least isometric energy. Throws mesh_error (closed_surface, degenerate_cell), parameter_error.
inline start_map conformal_start(const mesh<triangle>& m, const facet_table& f,
                                 const conformal_start_params& params = {})
{
    params.validate();
    const auto loops = boundary_loops(m, f);
    if (loops.empty())
        throw mesh_error(mesh_error::closed_surface, {}, "conformal_start: the surface is closed; cut it open");
    const double unit = unit_scale(m);
    const mesh<triangle> surface = scaled(m, unit);
    const ideal_elements<triangle> ideal(surface);

    start_map map;
    map.outline = impl::longest_loop(surface.points(), loops);
    map.holes = loops.size() - 1;
    map.uv = impl::spectral_conformal_map(surface, ideal, loops[map.outline], params.iterations);
    double stretch = 0, squeeze = 0;
    for (std::size_t c = 0; c < m.cells().size(); ++c)
    {
        const auto e = mapped_element<triangle>(surface, ideal, map.uv, c);
        stretch += e.measure * norm2(e.S);
        squeeze += e.measure * norm2(e.S) / (e.det * e.det);
    }
    if (const double scale = std::pow(squeeze / stretch, 0.25); std::isfinite(scale) && scale > 0)
        for (vec2& p : map.uv) p *= scale;
    assess(map, surface, ideal);
    for (vec2& p : map.uv) p /= unit; // a power of two: exact
    if (map.flips) return map;
    return coarse_start(m, make_hierarchy(m, {}, {.threads = params.fallback.coarse.threads}), params.fallback);
}

} // namespace taut::impl
