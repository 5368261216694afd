// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <string>

#include <taut/impl/map/session.hpp>

namespace taut::impl
{

/// The result of a session's only call: what its pins lack is what became of it.
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
                   (r.stopped ? "; give it more time" : "; no way there was found");
        r.ids = {r.farthest};
    }
    return result;
}

} // namespace taut::impl

namespace taut
{

/// Deforms a volume, or a mesh of the plane (z = 0), with as little distortion as the energy asks for, so that pins are
/// where they are wanted, bit for bit, and no element is inverted: one call of a session. Shapes with inverted elements
/// are untangled first.
///
/// What has no certified shape is gave_up or infeasible, as in a map_report; so is a shape whose pins could not be
/// brought to their places, which is returned with those as far as they came: injective, pins_held false. Where the
/// limits ended it before the pins were there, it is stopped.
/// Throws mesh_error, parameter_error, constraint_error, device_error.
template <class Element>
session_result<Element> deform(queue& q, const mesh<Element>& m, const deform_params<Element>& params)
{
    return impl::settled(session<Element>(q, m, params).solve());
}

/// Deforms a surface in space as a thin shell, so that pins are where they are wanted, bit for bit, and no triangle has
/// collapsed: one call of a session<hinge>. Outcomes as above; what begins with collapsed triangles gave_up.
///
///     const taut::thin_shell shell(surface);
///     auto pins = taut::constraints(shell.hinges()).pin(12, {0, 0, 1});
///     auto [x, report] = taut::deform(queue, shell, {.constraints = pins, .thickness = 0.01});
template <std::same_as<thin_shell> Shell>
session_result<hinge> deform(queue& q, const Shell& shell, const shell_params& params)
{
    return impl::settled(session<hinge>(q, shell, params).solve());
}

} // namespace taut
