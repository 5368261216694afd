// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/exact/branch_points.hpp>
#include <taut/impl/mesh/incidence.hpp>
#include <taut/impl/untangle/proofs/empty_star.hpp>
#include <taut/impl/untangle/proofs/fixed_elements.hpp>
#include <taut/impl/untangle/proofs/outline_proofs.hpp>
#include <taut/impl/untangle/proofs/pinned_boundary.hpp>

namespace taut::impl
{

/// Free vertices without a place: some of their triangles with two pinned corners contradict each other.
void judge_stars(const untangle_problem<triangle>& p, infeasibility& found);

/// Inner vertices that are pinned with all their neighbours so that these run around them more than once.
void judge_winding(const untangle_problem<triangle>& p, infeasibility& found);

/// Pinned vertices outside of their pinned boundary, and edges between pinned vertices that meet. Where the boundary is
/// pinned and does not meet itself, a map of positive triangles is one-to-one, so that such edges are a proof;
/// elsewhere they only say that the map covers parts twice.
void judge_places(const untangle_problem<triangle>& p, const facet_table& f, infeasibility& found);

} // namespace taut::impl

namespace taut
{

/// Searches for a proof that no map with these fixed coordinates is locally injective, without solving, in exact
/// arithmetic. Where none is found the problem may be feasible or not. Near-linear time: searches that would take
/// longer are cut short. Throws parameter_error as validate() does.
///
/// The proofs. The determinant of an element with all corners fixed does not change. The sum of the determinants within
/// a pinned outline is the area or volume that the outline encloses, and has to be positive. A surface of positive
/// triangles covers each point as often as its outline winds about it (the degree of the map), so no winding number is
/// negative; and with angles in (0, 2 pi] at the outline, which are the least, and multiples of 2 pi inside, the
/// theorem of Gauss and Bonnet says that the outline turns at least chi times. An inner vertex is covered, so its
/// winding number is positive. Within a simple boundary no point is covered twice, so no edges meet; elsewhere overlap
/// is no proof: a staircase in spirals has positive triangles only.
template <class Element>
impl::infeasibility find_infeasibility(const untangle_problem<Element>& problem)
{
    problem.validate();
    if (!problem.sliding.empty())
    {
        auto sure = problem;
        sure.held = problem.held_for_sure();
        sure.sliding.clear();
        return find_infeasibility(sure);
    }
    impl::infeasibility found;
    impl::judge_elements(problem, found);
    if (!problem.owners.empty()) return found; // the others are of meshes that do not overlap
    if constexpr (Element::dimension == 2) impl::judge_stars(problem, found);
    if constexpr (Element::dimension == 2) impl::judge_winding(problem, found);
    const auto f = impl::facets(problem.rest);
    impl::judge_patches(problem, f, found);
    if constexpr (Element::dimension == 2) impl::judge_places(problem, f, found);
    return found;
}

// Compiled once, with the bodies.
extern template impl::infeasibility find_infeasibility(const untangle_problem<triangle>&);
extern template impl::infeasibility find_infeasibility(const untangle_problem<tetrahedron>&);

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/untangle/proofs/infeasible.ipp>
#endif
