// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <taut/impl/core/error.hpp>
#include <taut/impl/core/fixed_marks.hpp>
#include <taut/impl/mesh/cell_corners.hpp>

namespace taut
{

/// Untangling problem: a map to be made injective while some coordinates of some vertices are fixed exactly.
template <class Element>
struct untangle_problem
{
    static constexpr int D = Element::dimension;

    mesh<Element> rest;          ///< the shape that the map distorts as little as possible; planar meshes have z = 0
    std::vector<vec<D>> initial; ///< one per vertex, in any state; a fixed coordinate is a hard constraint
    impl::fixed_marks<D> held;   ///< one per vertex
    /// Initial guess: a valid map near the solution, whose fixed coordinates need not be at their targets; empty: none.
    std::vector<vec<D>> draft = {};
    /// Target shapes of elements, if not those at rest: edge matrices, upper triangular with a positive diagonal, one
    /// per cell; their measures are weights, too.
    std::vector<mat<D>> wanted = {};
    /// Owner of each simplex (mesh/cell_corners.hpp), where they are the corners of other cells; else empty.
    std::vector<idx> owners = {};
    /// Sliding vertices, which stages fix: proofs must not rely on their positions.
    std::vector<idx> sliding = {};

    /// Fixed coordinates that proofs may rely on.
    impl::fixed_marks<D> held_for_sure() const;

    /// True if no vertex of the boundary can move.
    bool outline_pinned() const;

    /// Checks the problem: one initial position and one set of fixed coordinates per vertex, all finite. Throws
    /// parameter_error.
    void validate() const;
};

template <class Element>
auto untangle_problem<Element>::held_for_sure() const -> impl::fixed_marks<D>
{
    auto marks = held;
    for (const idx v : sliding) marks[static_cast<std::size_t>(v)] = 0;
    return marks;
}

template <class Element>
bool untangle_problem<Element>::outline_pinned() const
{
    const auto outline = impl::boundary_facets(rest, owners);
    return std::all_of(outline.begin(), outline.end(),
                       [this](const auto& facet) {
                           return std::all_of(facet.begin(), facet.end(),
                                              [this](idx v) { return held.all(static_cast<std::size_t>(v)); });
                       });
}

template <class Element>
void untangle_problem<Element>::validate() const
{
    const std::size_t n = rest.points().size();
    if (initial.size() != n)
        throw parameter_error("initial", "one position a vertex: " + std::to_string(n) + ", not " +
                                             std::to_string(initial.size()));
    if (held.size() != n)
        throw parameter_error("held", "one set of coordinates a vertex: " + std::to_string(n) + ", not " +
                                          std::to_string(held.size()));
    if (!draft.empty() && draft.size() != n)
        throw parameter_error("draft", "one position a vertex, or none at all: " + std::to_string(n) + ", not " +
                                           std::to_string(draft.size()));
    const std::size_t cells = rest.cells().size();
    if (!wanted.empty() && wanted.size() != cells)
        throw parameter_error("wanted", "one matrix a cell, or none at all: " + std::to_string(cells) + ", not " +
                                            std::to_string(wanted.size()));
    if (!owners.empty() && owners.size() != cells)
        throw parameter_error("owners", "one per cell, or none at all: " + std::to_string(cells) + ", not " +
                                            std::to_string(owners.size()));
    for (std::size_t v = 0; v < n; ++v)
    {
        for (int k = 0; k < D; ++k)
            if (!std::isfinite(initial[v][k]))
                throw parameter_error("initial", "vertex " + std::to_string(v) + " is not finite");
        if (held[v] > held.every)
            throw parameter_error("held",
                                  "vertex " + std::to_string(v) + " has only " + std::to_string(D) + " coordinates");
    }
}

// Compiled once, with the bodies.
extern template struct untangle_problem<triangle>;
extern template struct untangle_problem<tetrahedron>;

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/constrain/untangle_problem.ipp>
#endif
