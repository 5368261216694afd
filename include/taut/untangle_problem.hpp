// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_UNTANGLE_PROBLEM_HPP
#define TAUT_UNTANGLE_PROBLEM_HPP

#include <vector>

#include <taut/elements.hpp>
#include <taut/impl/core/core/fixed_marks.hpp>

/// Untangling problems.
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

// Compiled once, with the bodies.
extern template struct untangle_problem<triangle>;

extern template struct untangle_problem<tetrahedron>;

} // namespace taut

#endif
#include <taut/impl/leave.inl>
