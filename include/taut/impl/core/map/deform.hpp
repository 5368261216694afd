// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/deform.hpp>

namespace taut::impl
{

/// Result of a session's only call, with the outcome by its pins.
template <class Element>
session_result<Element> settled(session_result<Element> result)
{
    session_report& r = result.report;
    if (r.outcome != outcome::valid || r.pins_held) return result;
    if (!r.reason.empty())
        r.outcome = outcome::infeasible;
    else
    {
        r.outcome = r.stopped ? outcome::stopped : outcome::gave_up;
        r.reason = "vertex " + std::to_string(r.farthest) + " is " + std::to_string(r.distance) + " from its place" +
                   (r.distance > 0 ? "" : ", and has not turned as far as it is to") +
                   (r.stopped ? "; give it more time" : "; no path there was found");
        r.ids = {r.farthest};
    }
    return result;
}

} // namespace taut::impl
