// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <taut/impl/compute/queue_counters.hpp>
#include <taut/impl/exact/crossings.hpp>
#include <taut/impl/objective/level_report.hpp>
#include <taut/impl/objective/precision.hpp>
#include <taut/impl/objective/stage_report.hpp>
#include <taut/impl/start/start_map.hpp>
#include <taut/impl/untangle/result.hpp>

namespace taut::impl
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

} // namespace taut::impl

namespace taut
{

/// Report of one run of parameterize(): its phases, and the measures and certificate of the map.
struct map_report
{
    taut::outcome outcome = outcome::no_valid_start;
    std::string reason;                          ///< why there is no valid map; empty if there is one
    std::vector<idx> ids;                        ///< elements or vertices that the reason concerns, see outcome
    std::vector<std::string> notes;              ///< decisions of the library
    taut::precision precision = precision::fp64; ///< precision of the calculation
    impl::start_map start;                  ///< the map that was optimised; of a coarse start without uv, on its level
    std::vector<impl::level_report> levels; ///< coarser levels, in their order in time
    std::vector<vec2> pin_origins;          ///< pinned vertices in the start before they were moved to their targets
    std::vector<impl::stage_report> stages; ///< all stages, also unsuccessful ones, in their order in time
    std::vector<impl::untangle_stage_report> untangling; ///< stages that made the start injective
    std::optional<impl::overlap_report> overlap;         ///< with parameterize_params::no_overlap, if there is a map
    std::vector<idx> concave; ///< of parameterize_params::polygons: convex in space, but not in the map; ascending
    double scale = 1;         ///< lengths of the map by those of the surface: other than 1 in the unit square
    certificate flips;        ///< certificate of the returned map, exact: flips and branch points
    solve::report solve;      ///< on the mesh itself; energies are means over the elements, with the chosen weights
    impl::map_seconds seconds;
    impl::queue_counters counters; ///< launches, host waits and bytes of this run
};

inline std::ostream& operator<<(std::ostream& out, const map_report& r)
{
    if (r.outcome != outcome::valid) return out << "no valid map: " << r.reason;
    return out << r.solve << ", " << std::to_string(r.flips.flipped) << " of " << std::to_string(r.flips.elements)
               << " flipped";
}

/// Result of parameterize(): a map and its report; `auto [uv, report] = parameterize(...)`.
struct map_result
{
    std::vector<vec2> uv; ///< one per vertex, in the user's order; units and place by parameterize_params::placement
    map_report report;

    /// True if the map is certified: no triangle is flipped, and there is no branch point.
    explicit operator bool() const { return report.outcome == outcome::valid; }
    const std::string& reason() const { return report.reason; }
};

} // namespace taut
