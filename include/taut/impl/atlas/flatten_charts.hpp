// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <taut/impl/atlas/chart_mesh.hpp>
#include <taut/impl/compute/queue.hpp>
#include <taut/impl/compute/queue_counters.hpp>
#include <taut/impl/core/observer.hpp>

namespace taut
{

/// Parameters of flatten_charts(). Every field has a sensible default.
struct flatten_params
{
    /// A chart is done when the decrease that Newton's model still predicts is below this part of its energy; 1e-12 to
    /// 1. The step that it was predicted for is taken nevertheless. With the default, energies end within 1e-4 of their
    /// minima, and mostly within 1e-6.
    double tolerance = 1e-5;

    /// Newton steps of a chart at most; 0 leaves charts at their starts.
    int max_iterations = 100;

    /// Millions of multiplications that the factorization of a chart may take; above, the chart goes to `parameterize`
    /// by itself. The default stands for about 5,000 triangles, where both take as long.
    double largest = 30;

    /// A map to begin with, one point per vertex of the chart mesh in any place and in units of the surface, or
    /// nothing. Charts where it is not valid begin with another one.
    std::span<const vec2> initial = {};

    /// Wall-clock limit of the whole call.
    std::chrono::duration<double> time_limit = std::chrono::duration<double>(std::numeric_limits<double>::infinity());

    /// Asked after each step of the charts at work: go on? progress::iteration counts charts that are done,
    /// progress::value is the mean energy of the maps there are.
    taut::observer observer = {};

    /// Throws parameter_error that names the field.
    void validate() const;
};

/// Outcome of flattening one chart.
enum class chart_outcome
{
    converged,  ///< the map is that of least energy, to the tolerance
    stuck,      ///< no step lowers the energy any more: mostly the limit of rounding
    iterations, ///< as many steps as allowed
    stopped,    ///< the time limit or the observer; the map is the best so far
    no_map      ///< there is no valid one: chart_report::reason
};

} // namespace taut

namespace taut::impl
{

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

} // namespace taut::impl

namespace taut
{

/// Result of flatten_charts(): one map for all charts, and a report for each.
struct flattened_charts
{
    std::vector<vec2> uv; ///< one per vertex of charts.surface, in units of the surface; (0, 0) where there is no map
    std::vector<impl::chart_report> charts;
    impl::flatten_seconds seconds;
    queue_counters counters; ///< launches, host waits and bytes
};

/// Maps every chart to the plane with a free boundary and the least isometric distortion (energy::isometric by area),
/// without flipping a triangle: all charts at once on the device. Each has its own steps, line search and end, and the
/// number of launches does not depend on how many there are. Charts lie anywhere in the plane and may overlap.
///
/// A chart is a disk or has holes; there is no map of one that is closed or has handles, and of none with a flat
/// triangle. Its map does not depend on what other charts there are. Every map that is returned as valid is certified
/// in exact arithmetic.
/// Throws parameter_error, device_error, build_error.
flattened_charts flatten_charts(queue& q, const chart_mesh& charts, const flatten_params& params = {});

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/atlas/flatten_charts.ipp>
#endif
