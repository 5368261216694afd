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

/// Outcome of untangling.
enum class untangle_outcome
{
    injective,  ///< no element is inverted and there is no branch point, in exact arithmetic
    infeasible, ///< no map is injective; untangle_result::reason and ids are the certificate
    gave_up     ///< none was found, and none is known not to exist
};

/// Stable name of an outcome, for programs.
constexpr std::string_view to_string(untangle_outcome outcome) noexcept
{
    return taut::impl::name_in<untangle_outcome::gave_up>({"injective", "infeasible", "gave up"}, outcome);
}

inline std::ostream& operator<<(std::ostream& out, untangle_outcome outcome)
{
    return out << to_string(outcome);
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

    untangle_outcome outcome = untangle_outcome::gave_up;
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
    explicit operator bool() const { return outcome == untangle_outcome::injective; }
};

template <class Element>
std::ostream& operator<<(std::ostream& out, const untangle_result<Element>& r)
{
    out << r.outcome;
    if (!r) return out << ": " << r.reason;
    return out << ", by " << r.stage;
}

} // namespace taut
