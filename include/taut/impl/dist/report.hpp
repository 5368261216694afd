// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <taut/impl/core/types.hpp>
#include <taut/impl/map/map_result.hpp>
#include <taut/impl/processes/phase_clock.hpp>

namespace taut::dist
{

/// Certificate of a mesh over many processes, as taut::certificate of one; counts in 64 bits.
struct certificate
{
    std::int64_t elements = 0;
    std::int64_t flipped = 0;             ///< elements that are turned over, flat or not finite; exact
    std::vector<std::int64_t> ids;        ///< the first of these, in the order of the caller's cells, by process
    std::int64_t branched = 0;            ///< inner edges (in the plane vertices) that are gone around more than once
    std::vector<std::int64_t> branch_ids; ///< the first of them: the ids of their vertices
    double min_det = 0, max_det = 0;      ///< mapped / rest measure

    explicit operator bool() const { return flipped == 0 && branched == 0; }
};

/// Report of a run over many processes; the same on all of them but for `seconds` and what is said to be of a process.
struct report
{
    taut::outcome outcome = taut::outcome::no_valid_start; ///< valid: there is a certified shape
    std::string reason;             ///< why there is none, or why pins are not at their targets; else empty
    std::vector<std::int64_t> ids;  ///< elements or vertices that the reason concerns
    std::vector<std::string> notes; ///< decisions of the library
    bool converged = false;         ///< pins are met, and the shape is a minimum
    bool stopped = false;           ///< a limit or an observer ended the run
    bool pins_held = false;         ///< all pins are met, bit for bit
    double distance = 0;            ///< of the vertex that is farthest from its pin
    double energy = 0;              ///< mean over the elements, springs included
    double gradient = 0;            ///< its relative norm
    int steps = 0;                  ///< of Newton's method
    int products = 0;               ///< of conjugate gradients, all steps together
    int setups = 0;                 ///< of the preconditioner
    int fallbacks = 0;              ///< how often a safer preconditioner was needed
    std::int64_t unknowns = 0;      ///< vertices that may move
    std::int64_t on_interfaces = 0; ///< vertices inside that smooth() keeps to interfaces
    certificate flips;              ///< of the shape that is returned
    impl::phase_seconds seconds;    ///< of this process
    std::int64_t own_vertices = 0, halo_vertices = 0, local_cells = 0; ///< of this process
    std::uint64_t device_bytes = 0;                                    ///< in buffers of its device
};

} // namespace taut::dist
