// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include <taut/impl/map/map_result.hpp>

namespace taut::impl
{

/// Limits of one call of session::solve. The first that is reached ends it. At least one step is made if there is
/// something to do, except by the first call, which may return its initial shape.
struct session_budget
{
    /// Wall-clock limit. No step is begun that would exceed it if it took as long as the last one.
    std::chrono::duration<double> time = std::chrono::duration<double>(std::numeric_limits<double>::infinity());

    /// Maximum number of Newton steps. Range >= 1.
    int steps = std::numeric_limits<int>::max();

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (!(time.count() >= 0)) throw parameter_error("time", "must not be negative");
        if (steps < 1) throw parameter_error("steps", "must be at least 1");
    }
};

/// Wall-clock seconds of the phases of one call.
struct session_seconds
{
    double start = 0;       ///< the first map or shape, and what is made once for all calls
    double constrain = 0;   ///< updates of the fixed coordinates and their targets
    double follow = 0;      ///< steps that bring pins to their targets
    double repair = 0;      ///< untangling, where such steps stuck
    double solve = 0;       ///< minimisation with the pins at their targets
    double certificate = 0; ///< the map back from the device, and the count of its defects
    double total() const { return start + constrain + follow + repair + solve + certificate; }
};

} // namespace taut::impl

namespace taut
{

/// Report of one call of session::solve: its steps, and the measures and certificate of the map.
struct session_report
{
    /// `valid`: there is a certified map. Otherwise there are no coordinates, and reason and ids are as in map_report.
    taut::outcome outcome = outcome::no_valid_start;
    std::string reason;             ///< why there is no valid map, or why the pins cannot be reached; else empty
    std::vector<idx> ids;           ///< elements or vertices that the reason concerns
    std::vector<std::string> notes; ///< decisions of the library
    bool converged = false;         ///< pins are met, and the map is a minimum
    bool stopped = false;           ///< the budget, a limit or the observer ended the call
    bool pins_held = false;         ///< all pins are met, bit for bit
    idx farthest = -1;              ///< the vertex farthest from its pin; -1: pins are met
    double distance = 0;            ///< distance of that vertex from its pin
    double energy = 0;              ///< mean over the elements, springs included
    double gradient = 0;            ///< relative norm of the gradient, where pins are met
    int steps = 0;                  ///< Newton steps of this call
    certificate flips;              ///< certificate of the returned map, exact
    impl::session_seconds seconds;
    std::vector<impl::stage_report> stages; ///< stages of this call, in their order in time
    impl::queue_counters counters;          ///< counts of this call
};

inline std::ostream& operator<<(std::ostream& out, const session_report& r)
{
    if (r.outcome != outcome::valid) return out << "no valid map: " << r.reason;
    out << "E " << r.energy << (r.converged ? ", converged, " : ", not converged, ") << r.steps << " steps, ";
    if (!r.pins_held && r.farthest >= 0) out << "pin of vertex " << r.farthest << ' ' << r.distance << " away, ";
    return out << r.flips.flipped << " of " << r.flips.elements << " inverted";
}

/// Result of session::solve: positions and a report; `auto [uv, report] = s.solve(...)`.
template <class Element>
struct session_result
{
    std::vector<vec<Element::dimension>> x; ///< one per vertex, in the user's order and lengths
    session_report report;

    /// True if there is a map: it is certified.
    explicit operator bool() const { return report.outcome == outcome::valid; }
    const std::string& reason() const { return report.reason; }
};

} // namespace taut
