// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include <taut/impl/core/name_in.hpp>
#include <taut/impl/exact/certify.hpp>
#include <taut/impl/objective/stage_report.hpp>

namespace taut
{

/// Outcome of a run. Only `valid` comes with a certified map: no element is inverted, and there is no inner vertex of a
/// surface that the map winds around other than once; in exact arithmetic.
enum class outcome
{
    valid,          ///< the map is certified; map_report::solve says why the optimisation ended
    no_valid_start, ///< no injective start was found; map_report::reason and ids say where
    stopped,        ///< the time limit or the observer ended the run before there was a map; there are no coordinates
    infeasible,     ///< no map obeys the pins without inverted elements; reason and ids are the proof
    gave_up         ///< untangling did not succeed; the map has the fewest defects that were seen, ids are theirs
};

/// Stable name of an outcome, for programs.
constexpr std::string_view to_string(outcome what) noexcept
{
    return taut::impl::name_in<outcome::gave_up>({"valid", "no valid start", "stopped", "infeasible", "gave up"}, what);
}

} // namespace taut

namespace taut::impl
{

/// Report of one stage of an untangling. Energies are the regularised ones of its first and last step.
struct untangle_stage_report : stage_report
{
    std::size_t inverted = 0; ///< elements inverted in the best map when it ended
    std::size_t branched = 0; ///< branch points of that map
};

} // namespace taut::impl

namespace taut
{

/// Result of untangle(): the outcome, the best map and its stages.
template <class Element>
struct untangle_result
{
    static constexpr int D = Element::dimension;

    taut::outcome outcome = outcome::gave_up;
    std::string reason;      ///< why there is no injective map; empty if there is one
    std::vector<idx> ids;    ///< infeasible: what the proof names; gave_up: the inverted elements of the map, or its
                             ///< branch points where none is inverted
    std::vector<vec<D>> map; ///< map with the fewest defects found; fixed coordinates as in the problem
    certificate flips;       ///< certificate of the map, exact; det in the units of the map, not divided by anything
    double least_relative_det = 0; ///< smallest mapped / rest measure, divided by that of the whole; 1: a dilation
    std::string stage;             ///< stage that found the injective map; "initial" if there was nothing to do
    std::vector<impl::untangle_stage_report> stages; ///< those that ran, in their order, proofs and margin included
    double seconds = 0;                              ///< wall-clock seconds of the whole run

    /// True if the map is certified.
    explicit operator bool() const { return outcome == outcome::valid; }
};

template <class Element>
std::ostream& operator<<(std::ostream& out, const untangle_result<Element>& r)
{
    out << (r ? "injective" : to_string(r.outcome));
    if (!r) return out << ": " << r.reason;
    return out << ", by " << r.stage;
}

} // namespace taut
