// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <taut/impl/core/core/budget.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/hierarchy/coarser_volume.hpp>
#include <taut/impl/core/start/gradient_fit.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::impl
{

/// Untangling problem of an initial guess on a coarser volume.
struct coarse_problem
{
    coarser_volume thinned;                ///< of the current shape
    untangle_problem<tetrahedron> problem; ///< of the targets of fixed vertices, that shape at rest
};

/// None where the mesh is too small, its cells overlap, or it cannot be coarsened well.
inline std::optional<coarse_problem> coarser(const untangle_problem<tetrahedron>& p, const budget& clock)
{
    constexpr double factor = 8, least = 1000; // free vertices on the coarser one: with fewer limbs get lost
    std::vector<char> held(p.held.size());
    for (std::size_t v = 0; v < held.size(); ++v) held[v] = p.held.any(v);
    const auto free = static_cast<double>(std::count(held.begin(), held.end(), 0));
    if (!p.owners.empty() || free < factor * least) return std::nullopt;
    auto thinned =
        make_coarser(mesh<tetrahedron>(p.draft, p.rest.cells()), held, factor, [&clock] { return clock.in_time(); });
    if (2 * thinned.vertices.size() > held.size()) return std::nullopt;
    untangle_problem<tetrahedron> q{
        thinned.volume, {}, fixed_marks<3>(thinned.vertices.size()), thinned.volume.points()};
    for (std::size_t k = 0; k < thinned.vertices.size(); ++k)
    {
        const auto v = static_cast<std::size_t>(thinned.vertices[k]);
        q.initial.push_back(p.initial[v]);
        q.held[k] = p.held[v];
    }
    return coarse_problem{std::move(thinned), std::move(q)};
}

/// Gradients of a shape of m at its vertices: means of those of their cells, weighted by measure.
inline std::vector<mat3> vertex_gradients(const mesh<tetrahedron>& m, const std::vector<vec3>& x)
{
    const auto at = [](idx v) { return static_cast<std::size_t>(v); };
    std::vector<mat3> sums(x.size(), mat3(0.0));
    std::vector<double> measure(x.size(), 0.0);
    for (const auto& t : m.cells())
    {
        mat3 before, now;
        for (int k = 0; k < 3; ++k)
        {
            const auto corner = at(t[static_cast<std::size_t>(k) + 1]);
            before[k] = m.points()[corner] - m.points()[at(t[0])];
            now[k] = x[corner] - x[at(t[0])];
        }
        const double volume = glm::determinant(before);
        for (const idx v : t)
        {
            sums[at(v)] += volume * now * glm::inverse(before);
            measure[at(v)] += volume;
        }
    }
    for (std::size_t v = 0; v < x.size(); ++v) sums[v] /= measure[v];
    return sums;
}

/// Prolongs x, a shape of the coarser volume, to the mesh m: gradients are those of the coarser one at its vertices,
/// smooth in between, and the shape is the one whose gradients are nearest to them. Fixed coordinates have the targets
/// `to`.
inline std::vector<vec3> prolonged_guess(const gradient_fit<tetrahedron>& poisson, const mesh<tetrahedron>& m,
                                         const coarser_volume& coarse, const std::vector<vec3>& x,
                                         const fixed_marks<3>& held, const std::vector<vec3>& to)
{
    const auto at = [](idx v) { return static_cast<std::size_t>(v); };
    const auto gradients = vertex_gradients(coarse.volume, x);
    std::vector<vec3> y = to;
    std::vector<mat3> F(y.size(), mat3(1.0));
    for (std::size_t v = 0; v < y.size(); ++v)
    {
        if (coarse.into[v] < 0) continue;
        const auto u = at(coarse.into[v]);
        F[v] = gradients[u];
        const vec3 place = x[u] + F[v] * (m.points()[v] - coarse.volume.points()[u]);
        for (int k = 0; k < 3; ++k)
            if (!held.test(v, k)) y[v][k] = place[k];
    }
    constexpr int sweeps = 4; // as many edges of m are about one of the coarser volume
    const csr neighbours = vertex_neighbours(m);
    const auto is_left = [&](std::size_t v) { return at(coarse.vertices[at(coarse.into[v])]) == v; };
    for (int sweep = 0; sweep < sweeps; ++sweep)
    {
        const auto before = F;
        parallel_for(F.size(),
                     [&](std::size_t begin, std::size_t end)
                     {
                         for (std::size_t v = begin; v < end; ++v)
                         {
                             const auto ring = neighbours.row(static_cast<idx>(v));
                             if (ring.empty() || is_left(v)) continue;
                             F[v] = mat3(0.0);
                             for (const idx w : ring) F[v] += before[at(w)];
                             F[v] /= double(ring.size());
                         }
                     });
    }
    constexpr double enough = 1e-2; // an initial guess
    const auto wanted = [&](std::size_t c)
    {
        mat3 mean(0.0);
        for (const idx v : m.cells()[c]) mean += 0.25 * F[at(v)];
        return mean;
    };
    poisson.fit(wanted, held, enough, y);
    return y;
}

} // namespace taut::impl
