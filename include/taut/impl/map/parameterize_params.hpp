// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <taut/impl/constrain/constraints.hpp>
#include <taut/impl/constrain/placement.hpp>
#include <taut/impl/energy/any_energy.hpp>
#include <taut/impl/map/tuning.hpp>
#include <taut/impl/mesh/cell_data.hpp>
#include <taut/impl/objective/precision.hpp>
#include <taut/impl/solve/params.hpp>
#include <taut/impl/start/barycentric_params.hpp>

namespace taut
{

/// Treatment of the boundary during the optimisation.
enum class boundary_mode
{
    free,  ///< it moves like everything else
    fixed, ///< it stays where `initial` has it; without that on a circle
    square ///< the same; without `initial` on a square
};

/// Method of the initial map.
enum class start_method
{
    automatic,   ///< `initial` if there is one; else coarse for Newton's method and barycentric for the others
    coarse,      ///< made and minimised on coarser levels of the mesh (start/nested.hpp)
    barycentric, ///< on a convex polygon, with weights that reduce stretch (start/barycentric_map.hpp)
    tutte,       ///< on a convex polygon, with uniform weights
    mean_value,  ///< on a convex polygon, with mean value weights (Floater 2003)
    conformal    ///< spectral conformal, or coarse_start() where that has flips (start/conformal.hpp)
};

/// Parameters of parameterize(). Every field has a sensible default.
struct parameterize_params
{
    /// Energy to be minimised. A user's struct converts, alone or with parameters, as {cloth{}, {0.5}}; so do sums and
    /// products of energies.
    any_energy energy = impl::default_energy();

    /// Weights of elements in the sum: rest area, as is usual, or all equal, as in the paper.
    energy::weighting weights = energy::weighting::measure;

    /// Data of single triangles that energies read, in the order of the mesh: weights, attributes, directions.
    cell_data data = {};

    boundary_mode boundary = boundary_mode::free;

    /// Spacing of vertices on the circle or square, also that of a start with a free boundary.
    boundary_spacing spacing = boundary_spacing::chord;

    /// Pins, which are met bit for bit, and springs. The start is brought near them and untangled.
    taut::constraints<triangle> constraints = {};

    /// Initial coordinates, one per vertex, or empty (a warm start: the map of the last run, after the pins have moved,
    /// say); with a free boundary and no constraints their translation and scale do not matter. A start that is
    /// mirrored as a whole is reflected, others with flips are untangled.
    std::vector<vec2> initial = {};

    /// Method of the start if there are no initial coordinates. A coarse start falls back to a barycentric one where it
    /// fails.
    start_method start = start_method::automatic;

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

    /// Method, line search (except of Newton's method, which is the `automatic` one here), tolerances. Where they are
    /// given as a whole (`.solve = {...}`), a run that has only settled goes on.
    solve::params solve = {.tuning = {.stopping = {.settled_tolerance = 1e-4}}};

    /// Not for users: what tests and measurements set.
    impl::map_tuning tuning = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (weights != energy::weighting::uniform && weights != energy::weighting::measure)
            throw parameter_error("weights", "must be uniform or measure");
        if (boundary != boundary_mode::free && boundary != boundary_mode::fixed && boundary != boundary_mode::square)
            throw parameter_error("boundary", "must be free, fixed or square");
        if (start < start_method::automatic || start > start_method::conformal)
            throw parameter_error("start", "must be automatic, coarse, barycentric, tutte, mean_value or conformal");
        if (precision != precision::automatic && precision != precision::fp64 && precision != precision::mixed &&
            precision != precision::fp32)
            throw parameter_error("precision", "must be automatic, fp64, mixed or fp32");
        if (placement != placement::upright && placement != placement::unit_square && placement != placement::as_solved)
            throw parameter_error("placement", "must be upright, unit_square or as_solved");
        solve.validate();
        if (solve.method == solve::method::automatic) solve.require_newton_search();
    }

    /// Parameters of barycentric starts.
    impl::barycentric_params barycentric() const
    {
        const bool uniform = start == start_method::tutte, plain = uniform || start == start_method::mean_value;
        return {.boundary = {.shape = boundary == boundary_mode::square ? impl::boundary_shape::square
                                                                        : impl::boundary_shape::circle,
                             .spacing = spacing},
                .weights = uniform ? impl::barycentric_weights::uniform : impl::barycentric_weights::mean_value,
                .stretch_rounds = plain ? 0 : tuning.stretch_rounds};
    }

    /// Returns whether the method works on a hierarchy of levels.
    bool uses_levels() const
    {
        return multigrid || solve.method == solve::method::automatic || solve.method == solve::method::newton;
    }
};

} // namespace taut
