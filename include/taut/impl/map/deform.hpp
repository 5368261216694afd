// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <string>

#include <taut/impl/map/session.hpp>

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
                   (r.stopped ? "; give it more time" : "; no path there was found");
        r.ids = {r.farthest};
    }
    return result;
}

} // namespace taut::impl

namespace taut
{

/// Deforms a volume, or a mesh of the plane (z = 0), with as little distortion as the energy asks for, so that pins are
/// met bit for bit and no element is inverted: one call of a session. Shapes with inverted elements are untangled
/// first.
///
/// The outcome is gave_up or infeasible, as in a map_report, where no certified shape was found, or pins could not be
/// brought to their targets; in the latter case the injective shape with the pins as far as they came is returned,
/// pins_held false. It is stopped where the limits ended the run before the pins reached their targets.
/// Throws mesh_error, parameter_error, constraint_error, device_error.
template <class Element>
session_result<Element> deform(queue& q, const mesh<Element>& m, const deform_params<Element>& params,
                               const run_limits& limits = {})
{
    return impl::settled(session<Element>(q, m, params, limits).solve());
}

/// Deforms a surface in space as a thin shell, so that pins are met bit for bit and no triangle is collapsed: one call
/// of a session<hinge>. Outcomes as above; a start with collapsed triangles is gave_up.
///
///     const taut::thin_shell shell(surface);
///     auto pins = taut::constraints(shell.hinges()).pin(12, {0, 0, 1});
///     auto [x, report] = taut::deform(queue, shell, {.constraints = pins, .thickness = 0.01});
template <std::same_as<thin_shell> Shell>
session_result<hinge> deform(queue& q, const Shell& shell, const shell_params& params, const run_limits& limits = {})
{
    return impl::settled(session<hinge>(q, shell, params, limits).solve());
}

} // namespace taut
