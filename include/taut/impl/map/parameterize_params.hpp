// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <taut/impl/constrain/constraints.hpp>
#include <taut/impl/constrain/placement.hpp>
#include <taut/impl/core/observer.hpp>
#include <taut/impl/energy/any_energy.hpp>
#include <taut/impl/mesh/cell_data.hpp>
#include <taut/impl/objective/precision.hpp>
#include <taut/impl/solve/params.hpp>
#include <taut/impl/start/barycentric_params.hpp>
#include <taut/impl/untangle/params.hpp>

namespace taut
{

/// Treatment of the boundary during the optimisation.
enum class boundary_mode
{
    free, ///< it moves like everything else
    fixed ///< it stays where the start map has it
};

/// Method of the initial map.
enum class start_method
{
    automatic,   ///< `initial` if there is one; else coarse for Newton's method and barycentric for the others
    coarse,      ///< made and minimised on coarser levels of the mesh (start/nested.hpp)
    barycentric, ///< on a convex polygon (start/barycentric_map.hpp)
    conformal    ///< spectral conformal, or coarse_start() where that has flips (start/conformal.hpp)
};

/// Parameters of parameterize(). Every field has a sensible default.
struct parameterize_params
{
    /// Energy to be minimised. A user's struct converts; so do sums and products of energies.
    any_energy energy = impl::default_energy();

    /// Weights of elements in the sum: rest area, as is usual, or all equal, as in the paper.
    energy::weighting weights = energy::weighting::measure;

    /// Data of single triangles that energies read, in the order of the mesh: weights, attributes, directions.
    cell_data data = {};

    /// Numbers that the energy reads as e.parameter(k): changing them needs no new kernel.
    std::vector<double> parameters = {};

    boundary_mode boundary = boundary_mode::free;

    /// Pins, which are met bit for bit, and springs. The start is brought near them and untangled.
    taut::constraints<triangle> constraints = {};

    /// Initial coordinates, one per vertex, or empty (a warm start: the map of the last run, after the pins have moved,
    /// say); with a free boundary and no constraints their translation and scale do not matter. A start that is
    /// mirrored as a whole is reflected, others with flips are untangled.
    std::vector<vec2> initial = {};

    /// Method of the start if there are no initial coordinates. A coarse start takes its boundary from `barycentric`
    /// and falls back to a barycentric one where it fails.
    start_method start = start_method::automatic;
    impl::barycentric_params barycentric = {.stretch_rounds = 10};

    /// Placement of an unconstrained map: a free boundary without pins and springs.
    taut::placement placement = placement::upright;

    /// True if surfaces with holes (more than one boundary loop) are accepted. Their maps are locally injective.
    bool holes = false;

    /// True if the boundary of the map must not cross or touch itself, so that no two triangles overlap. If it does,
    /// the energy is minimised once more, through maps without crossings (docs/howto/overlap.md); other maps are
    /// unchanged.
    bool no_overlap = false;

    /// Number of the polygon of each triangle, from 0, or empty. Polygons that are convex in space become convex in the
    /// map, so that their triangles are positive however a reader of a file cuts them; map_report::concave has those
    /// for which fixed coordinates or limits prevent it.
    std::vector<idx> polygons = {};

    taut::precision precision = precision::automatic;

    /// True if lbfgs and conjugate_gradient are preconditioned by a multigrid V-cycle of the Hessian at the start.
    /// Newton's method always is.
    bool multigrid = false;

    /// Parameters of untangling a start with flips. Its time limit and observer are overruled by those below.
    untangle_params untangling = {};

    /// Solver parameters: method, line search (except of Newton's method, which is the `automatic` one here), stopping.
    /// `solve.stopping.time_limit` is overruled by time_limit below. With stopping parameters given as a whole
    /// (`.stopping = {...}`), a run that has only settled goes on.
    solve::params solve = {.stopping = {.settled_tolerance = 1e-4}};

    /// Time and observer of the whole call. progress::usable: whether there is a map that would be returned.
    run_limits limits = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        limits.validate();
        if (weights != energy::weighting::uniform && weights != energy::weighting::measure)
            throw parameter_error("weights", "must be uniform or measure");
        if (boundary != boundary_mode::free && boundary != boundary_mode::fixed)
            throw parameter_error("boundary", "must be free or fixed");
        if (start != start_method::automatic && start != start_method::coarse && start != start_method::barycentric &&
            start != start_method::conformal)
            throw parameter_error("start", "must be automatic, coarse, barycentric or conformal");
        if (precision != precision::automatic && precision != precision::fp64 && precision != precision::mixed &&
            precision != precision::fp32)
            throw parameter_error("precision", "must be automatic, fp64, mixed or fp32");
        if (placement != placement::upright && placement != placement::unit_square && placement != placement::as_solved)
            throw parameter_error("placement", "must be upright, unit_square or as_solved");
        untangling.validate();
        solve.validate();
        if (solve.method == solve::method::automatic) solve.require_newton_search();
    }

    /// Returns whether the method works on a hierarchy of levels.
    bool uses_levels() const
    {
        return multigrid || solve.method == solve::method::automatic || solve.method == solve::method::newton;
    }
};

} // namespace taut
