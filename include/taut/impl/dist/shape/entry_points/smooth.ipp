// SPDX-License-Identifier: MIT
#pragma once

#include <taut/dist.hpp>
#include <taut/impl/dist/shape/smooth.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/energies.hpp>
#include <taut/impl/core/constrain/boundary_slides.hpp>
#include <taut/impl/core/mesh/cell_corners.hpp>
#include <taut/impl/dist/shape/kept_interfaces.hpp>
#include <taut/impl/dist/shape/shape_body.hpp>

namespace taut::dist::impl
{

/// What keeps the boundary of a part: fixed coordinates of owned vertices, and projections of those that slide.
template <class Element>
struct kept_boundary
{
    constraints<Element> pins;
    std::vector<mat<Element::dimension>> slides; ///< one a vertex of the part
    std::int64_t on_interfaces = 0;              ///< owned vertices of the surfaces inside
};

/// Facets of owned vertices have all their elements in the part; others may look like the boundary. surfaces: what
/// keeps its shape besides.
template <class Element>
kept_boundary<Element> boundary_of(const part<Element>& p, const smooth_params& params,
                                   const std::vector<taut::impl::kept_facet>& surfaces)
{
    constexpr int D = Element::dimension;
    kept_boundary<Element> kept;
    kept.slides.assign(p.size(), mat<D>(1.0));
    if (p.corners.empty() || (params.boundary == smooth_boundary::free && surfaces.empty())) return kept;
    const mesh<Element> m(p.points, p.corners);
    auto facets = taut::impl::boundary_facets(m, std::span<const idx>(p.owners));
    std::erase_if(facets,
                  [&](const auto& f) { return std::none_of(f.begin(), f.end(), [&](idx v) { return p.owns(v); }); });
    std::vector<char> inside(p.size(), 0);
    for (const auto& facet : surfaces)
        for (const idx v : facet.corners()) inside[static_cast<std::size_t>(v)] = p.owns(v);
    for (const auto& facet : facets)
        for (const idx v : facet) inside[static_cast<std::size_t>(v)] = 0;
    kept.on_interfaces = std::count(inside.begin(), inside.end(), 1);
    taut::impl::kept_directions<Element> directions(m);
    if (params.boundary == smooth_boundary::sliding)
        directions.add(std::span<const std::array<idx, static_cast<std::size_t>(D)>>(facets));
    directions.add(surfaces);
    const auto motion = directions.motion();
    for (const auto& [v, pin] : motion.pins.pins())
        for (int k = 0; k < D; ++k)
            if (p.owns(v) && (pin.held >> k & 1U) != 0)
                kept.pins.pin(p.ids[static_cast<std::size_t>(v)], k, pin.value[k]);
    for (const auto& s : motion.slides)
        if (p.owns(s.vertex)) kept.slides[static_cast<std::size_t>(s.vertex)] = s.projection;
    if (params.boundary != smooth_boundary::fixed) return kept;
    std::vector<char> seen(p.size(), 0);
    for (const auto& f : facets)
        for (const idx v : f)
            if (const auto at = static_cast<std::size_t>(v); p.owns(v) && seen[at]++ == 0)
            {
                kept.pins.pin(p.ids[at], vec<D>(p.points[at]));
                kept.slides[at] = mat<D>(1.0);
            }
    return kept;
}

/// Collective. Fixed vertices are where they are, wherever that is known.
template <class Element>
void pin_fixed(const part<Element>& p, const std::vector<std::int64_t>& fixed, kept_boundary<Element>& kept)
{
    constexpr int D = Element::dimension;
    const auto numbers = p.find(fixed);
    parcels<std::int64_t> to(p.all.ranks());
    p.all.together(
        [&]
        {
            for (std::size_t i = 0; i < numbers.size(); ++i)
            {
                if (numbers[i] < 0)
                    throw constraint_error(constraint_error::out_of_range, {},
                                           "fixed vertex " + std::to_string(fixed[i]) +
                                               " is none of the mesh; count from 0");
                const auto at = p.place_of(numbers[i]);
                to[at.rank].push_back(at.place);
            }
        });
    for (const std::int64_t v : p.all.exchange(to).items)
    {
        const auto at = static_cast<std::size_t>(v);
        kept.pins.pin(p.ids[at], vec<D>(p.points[at]));
        kept.slides[at] = mat<D>(1.0);
    }
}

/// Collective. Whether any vertex slides; then the halo knows the directions, too.
template <class Element>
bool slides(const part<Element>& p, kept_boundary<Element>& kept)
{
    constexpr int D = Element::dimension;
    std::vector<double> flat;
    bool any = false;
    for (const auto& P : kept.slides)
        for (int k = 0; k < D; ++k)
            for (int j = 0; j < D; ++j)
            {
                flat.push_back(P[k][j]);
                any = any || P[k][j] != (k == j ? 1.0 : 0.0);
            }
    any = p.all.any(any);
    if (any)
    {
        p.update(flat, D * D);
        for (std::size_t v = 0, i = 0; v < kept.slides.size(); ++v)
            for (int k = 0; k < D; ++k)
                for (int j = 0; j < D; ++j) kept.slides[v][k][j] = flat[i++];
    }
    return any;
}

template <class Element>
session<Element> smoothing_session(MPI_Comm comm, const mesh_piece<Element>& piece, const smooth_params& params)
{
    constexpr int D = Element::dimension;
    const communicator all(comm);
    all.together([&] { params.validate(); });
    deform_params<Element> how{.energy = energy::shape_power{params.worst_exponent},
                               .weights = energy::weighting::uniform,
                               .regular = true,
                               .solve = params.solve,
                               .solver = params.solver,
                               .queue = params.queue};
    for (const vec3& x : params.initial) how.initial.push_back(vec<D>(x));
    // Cells count alike, and so do corners, as in smoothing by one process.
    mesh_piece<Element> unweighted;
    if (!piece.weights.empty())
    {
        unweighted = piece;
        unweighted.weights.clear();
    }
    session<Element> s(comm, piece.weights.empty() ? piece : unweighted, how);
    const auto& p = s.body().mesh_part();
    kept_boundary<Element> kept;
    const auto surfaces = kept_interfaces(p, piece, params);
    all.together([&] { kept = boundary_of(p, params, surfaces); });
    s.body().keep_to_interfaces(all.sum(kept.on_interfaces));
    pin_fixed(p, params.fixed, kept);
    if (slides(p, kept)) s.body().slide(std::move(kept.slides));
    s.constrain(kept.pins);
    return s;
}

} // namespace taut::dist::impl

namespace taut::dist
{

template <class Element>
result<Element> smooth(MPI_Comm comm, const mesh_piece<Element>& piece, const smooth_params& params,
                       const run_limits& limits)
{
    return impl::smoothing_session<Element>(comm, piece, params).solve(limits);
}

} // namespace taut::dist
