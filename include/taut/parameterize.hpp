// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_PARAMETERIZE
#endif
#ifndef TAUT_PARAMETERIZE_HPP
#define TAUT_PARAMETERIZE_HPP

#include <cstddef>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <taut/any_energy.hpp>
#include <taut/cell_data.hpp>
#include <taut/certify.hpp>
#include <taut/constraints.hpp>
#include <taut/impl/core/exact/crossings.hpp>
#include <taut/impl/core/map/tuning.hpp>
#include <taut/impl/core/start/barycentric_params.hpp>
#include <taut/mesh.hpp>
#include <taut/options.hpp>
#include <taut/queue.hpp>
#include <taut/solve_params.hpp>
#include <taut/start_map.hpp>
#include <taut/untangle.hpp>

/// Maps of surfaces to the plane, certified to be injective.
namespace taut
{

/// Wall-clock seconds of the phases of one run.
struct map_seconds
{
    double device = 0;    ///< kernel builds and their first launches
    double setup = 0;     ///< validation, ordering, ideal elements, matrices and lists of the mesh itself, transfers
    double hierarchy = 0; ///< coarser levels of the mesh
    double start = 0;     ///< start map; of a coarse start all that happens on coarser levels
    double untangle = 0;  ///< making the start injective under the constraints
    double solve = 0;     ///< minimisation on the mesh itself
    double overlap = 0;   ///< looking for crossings of the boundary, and minimisation without them
};

/// Report on crossings of the boundary: pairs of its edges that have a common point beyond a common end.
struct overlap_report
{
    impl::crossing_count before; ///< crossings of the map without parameterize_params::no_overlap
    double energy_before = 0;    ///< energy of that map, where it has any
    int rounds = 0; ///< rounds of the minimisation without crossings; 0: none was needed, or there was no time
    std::size_t crossings = 0; ///< crossings of the returned map, exact: 0 in valid ones
};

/// Report of one run of parameterize(): its phases, and the measures and certificate of the map.
struct map_report
{
    taut::outcome outcome = outcome::no_valid_start;
    std::string reason;                          ///< why there is no valid map; empty if there is one
    std::vector<idx> ids;                        ///< elements or vertices that the reason concerns, see outcome
    std::vector<std::string> notes;              ///< decisions of the library
    taut::precision precision = precision::fp64; ///< precision of the calculation
    start_map start;                  ///< the map that was optimised; of a coarse start without uv, on its level
    std::vector<level_report> levels; ///< coarser levels, in their order in time
    std::vector<vec2> pin_origins;    ///< pinned vertices in the start before they were moved to their targets
    std::vector<stage_report> stages; ///< all stages, also unsuccessful ones, in their order in time
    std::vector<untangle_stage_report> untangling; ///< stages that made the start injective
    std::optional<overlap_report> overlap;         ///< with parameterize_params::no_overlap, if there is a map
    std::vector<idx> concave; ///< of parameterize_params::polygons: convex in space, but not in the map; ascending
    double scale = 1;         ///< lengths of the map by those of the surface: other than 1 in the unit square
    certificate flips;        ///< certificate of the returned map, exact: flips and branch points
    solve::report solve;      ///< on the mesh itself; energies are means over the elements, with the chosen weights
    map_seconds seconds;
    queue_counters counters; ///< launches, host waits and bytes of this run
};

std::ostream& operator<<(std::ostream& out, const map_report& r);

/// Result of parameterize(): a map and its report; `auto [uv, report] = parameterize(...)`.
struct map_result
{
    std::vector<vec2> uv; ///< one per vertex, in the user's order; units and place by parameterize_params::placement
    map_report report;

    /// True if the map is certified: no triangle is flipped, and there is no branch point.
    explicit operator bool() const { return report.outcome == outcome::valid; }
    const std::string& reason() const { return report.reason; }
};

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
    any_energy energy = default_energy();

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

/// Maps a surface to the plane with as little distortion as the energy asks for and without flipping a triangle:
/// validate -> start map -> minimise on the queue's device -> certificate in exact arithmetic.
///
/// The map comes in the user's vertex order and in the units of the surface; a scale-invariant energy leaves the scale
/// open, and the map then has the area of the surface. An unconstrained map is placed by `placement`. On a stop for any
/// reason (limits, observer) the map is the best one so far, which is as valid as any, or there is none yet
/// (outcome::stopped).
/// Throws mesh_error (not a disk, degenerate triangle, ...), parameter_error, device_error.
map_result parameterize(queue& q, const mesh<triangle>& m, const parameterize_params& params = {},
                        const run_limits& limits = {});

} // namespace taut

#endif
#include <taut/impl/leave.inl>
