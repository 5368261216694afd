// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include <taut/impl/atlas/chart_mesh.hpp>
#include <taut/impl/compute/queue.hpp>
#include <taut/impl/compute/queue_counters.hpp>
#include <taut/impl/core/observer.hpp>
#include <taut/impl/objective/precision.hpp>
#include <taut/impl/solve/params.hpp>

namespace taut::impl
{

/// Solver of maps of a rough surface, which ends where two steps gain less than a hundredth each of what the map has
/// above an isometry. One alone may be short, the first one above all.
inline solve::params rough_solve(int max_iterations)
{
    return {
        .decrease_tolerance = 1e-2, .max_iterations = max_iterations, .tuning = {.stopping = {.decrease_count = 2}}};
}

/// Precision of maps of a rough surface: its needles are more than single precision holds.
inline precision rough_precision(const queue& q)
{
    return q.device().has_fp64() ? precision::fp64 : precision::automatic;
}

/// Tuning of flatten_charts().
struct flatten_tuning
{
    /// Maximum cost of the factorization of a chart in millions of multiplications; above, the chart is solved by
    /// `parameterize`. The default corresponds to about 5,000 triangles, where both take as long.
    double largest = 30;

    /// True for charts of a rough surface, on which coarser levels say little about finer ones: large charts begin with
    /// a barycentric map, and end as by rough_solve().
    bool rough = false;
};

} // namespace taut::impl

namespace taut
{

/// Parameters of flatten_charts(). Every field has a sensible default.
struct flatten_params
{
    /// Stopping tolerance: a chart is done when the predicted decrease of Newton's model is below this fraction of its
    /// energy; 1e-12 to 1. The predicted step is taken, too. With the default, energies end within 1e-4 of their
    /// minima, and mostly within 1e-6.
    double tolerance = 1e-5;

    /// Maximum number of Newton steps of a chart; 0 returns the starts.
    int max_iterations = 100;

    /// Initial map, one point per vertex of the chart mesh in any place and in units of the surface, or empty. Charts
    /// for which it is not valid get another start.
    std::span<const vec2> initial = {};

    /// Not for users: what tests and measurements set.
    impl::flatten_tuning tuning = {};

    /// Throws parameter_error that names the field.
    void validate() const;
};

} // namespace taut

namespace taut::impl
{

/// Outcome of flattening one chart.
enum class chart_outcome
{
    converged,  ///< the map is that of least energy, to the tolerance
    stuck,      ///< no step lowers the energy any more: mostly the limit of rounding
    iterations, ///< as many steps as allowed
    stopped,    ///< the time limit or the observer; the map is the best so far
    no_map      ///< there is no valid one: chart_report::reason
};

struct chart_report
{
    /// Area mean of energy::isometric, 4 at least; +infinity if the map is not valid.
    double energy = std::numeric_limits<double>::infinity();
    double start_energy = std::numeric_limits<double>::infinity(); ///< energy of the initial map
    int iterations = 0;                                            ///< Newton steps
    bool valid = false;     ///< no triangle is flipped, and there is no branch point; in exact arithmetic
    bool multigrid = false; ///< it went to `parameterize`
    chart_outcome outcome = chart_outcome::stopped;
    std::string reason = {}; ///< why there is no valid map

    bool settled() const { return outcome != chart_outcome::iterations; } ///< more steps would be of no use
};

/// Wall-clock seconds of the stages.
struct flatten_seconds
{
    double start = 0;   ///< first maps, on the host
    double device = 0;  ///< kernels built
    double prepare = 0; ///< orders, profiles, transfers
    double solve = 0;   ///< Newton's method
    double large = 0;   ///< charts that `parameterize` mapped
    double certify = 0;
};

/// Result of flatten_charts(): one map for all charts, and a report for each.
struct flattened_charts
{
    using enum chart_outcome; // so that an outcome is flattened_charts::no_map, say

    std::vector<vec2> uv; ///< one per vertex of charts.surface, in units of the surface; (0, 0) where there is no map
    std::vector<impl::chart_report> charts;
    impl::flatten_seconds seconds;
    queue_counters counters; ///< launches, host waits and bytes
};

} // namespace taut::impl

namespace taut
{

/// Maps every chart to the plane with a free boundary and the least isometric distortion (energy::isometric by area),
/// without flipping a triangle: all charts at once on the device. Each has its own steps, line search and stopping
/// test, and the number of launches does not depend on the number of charts. Charts lie anywhere in the plane and may
/// overlap.
///
/// A chart is a disk or has holes; closed charts, those with handles and those with a flat triangle have no map. Its
/// map does not depend on other charts. Every map that is returned as valid is certified in exact arithmetic.
/// The observer is asked after each step: progress::iteration counts finished charts, progress::value is the mean
/// energy of the current maps. Throws parameter_error, device_error, build_error.
impl::flattened_charts flatten_charts(queue& q, const chart_mesh& charts, const flatten_params& params = {},
                                      const run_limits& limits = {});

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/atlas/flatten_charts.ipp>
#endif
