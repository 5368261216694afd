// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include <taut/deform.hpp>
#include <taut/impl/core/constrain/prescribed_paths.hpp>

namespace taut::impl
{

/// How far pinned vertices have turned on their way to their targets, as the end of a sentence; empty where they do not
/// turn. from: the shape at the start.
template <class Element>
std::string turned_so_far(const session<Element>& s, const mesh<Element>& m,
                          const std::vector<vec<Element::dimension>>& from, idx farthest)
{
    const auto told = [](idx v, double turned, double asked)
    {
        const auto degrees = [](double angle) { return std::to_string(std::lround(angle * 180 / std::numbers::pi)); };
        return "; vertex " + std::to_string(v) + " has turned by " + degrees(turned) + " of " + degrees(asked) +
               " degrees";
    };
    const auto& pins = s.constraints();
    if (const auto& rotations = pins.rotations(); !rotations.empty())
    {
        const auto leads = [&](const auto& r)
        { return std::ranges::find(r.vertices(), farthest) != r.vertices().end(); };
        const auto at = std::ranges::find_if(rotations, leads);
        return at == rotations.end() ? told(rotations[0].vertices()[0], rotations[0].turned(), rotations[0].angle())
                                     : told(farthest, at->turned(), at->angle());
    }
    const auto marks = pins.held();
    const auto turn = [&](const auto& to)
    {
        return prescribed_paths<Element::dimension>(m.cells(), marks, from, to)
            .turn(static_cast<std::size_t>(farthest))
            .value_or(vec3(0.0));
    };
    auto to = from;
    pins.impose(to);
    const vec3 whole = turn(to);
    const double asked = glm::length(whole);
    if (asked < std::numbers::pi / 180) return {};
    return told(farthest, glm::dot(turn(s.x()), whole) / asked, asked);
}

/// Result of a session's only call, with the outcome by its pins. m, initial: its mesh and initial shape, if given.
template <class Element>
session_result<Element> settled(session<Element> s, const mesh<Element>& m,
                                std::vector<vec<Element::dimension>> initial)
{
    if (initial.empty()) initial.assign(m.points().begin(), m.points().end());
    auto result = s.solve();
    session_report& r = result.report;
    if (r.outcome != outcome::valid || r.pins_held) return result;
    if (!r.reason.empty())
        r.outcome = outcome::infeasible;
    else
    {
        r.outcome = r.stopped ? outcome::stopped : outcome::gave_up;
        r.reason = "vertex " + std::to_string(r.farthest) + " is " + std::to_string(r.distance) + " from its place" +
                   turned_so_far(s, m, initial, r.farthest) +
                   (r.stopped ? "; give it more time" : "; no path there was found");
        r.ids = {r.farthest};
    }
    return result;
}

} // namespace taut::impl
