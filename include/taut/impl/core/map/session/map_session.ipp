// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <ostream>
#include <utility>

#include <taut/impl/core/map/mapped.hpp>
#include <taut/impl/core/map/session/session_run.hpp>
#include <taut/impl/core/solve/stop.hpp>
#include <taut/session.hpp>

namespace taut::impl
{

/// Sets up the session of a map of a surface, with the start of parameterize(). Throws as that.
inline session_setup<triangle> map_setup(const queue& q, const mesh<triangle>& m, const parameterize_params& given,
                                         const run_limits& limits)
{
    struct
    {
        parameterize_params params;
        run_surface in;
    } both{validated(given), {m, given}};
    const auto& [params, in] = both;
    limits.validate();
    session_setup<triangle> setup{.of = {.rest = in.surface,
                                         .ideal = in.ideal,
                                         .energy = params.energy,
                                         .weights = params.weights,
                                         .data = params.data},
                                  .constraints = params.constraints,
                                  .still = in.fixed_boundary(params.boundary),
                                  .precision = params.precision,
                                  .solve = params.solve,
                                  .limits = limits};
    setup.first = [q, both = std::move(both)](const constraints<triangle>& wanted, run_clock& clock)
    {
        auto params = both.params;
        params.constraints = wanted;
        map_result found = mapped(q, both.in, params, clock);
        first_map<triangle> first{{}, found.report.precision, both.in.unit / found.report.scale};
        session_report& r = first.result.report;
        r.outcome = found.report.outcome;
        r.reason = std::move(found.report.reason);
        r.ids = std::move(found.report.ids);
        r.notes = std::move(found.report.notes);
        r.flips = std::move(found.report.flips);
        r.energy = found.report.solve.value;
        r.gradient = found.report.solve.gradient_norm;
        r.steps = found.report.solve.iterations;
        r.converged = found && solve::impl::converged(found.report.solve.stop);
        if (found) first.result.x = std::move(found.uv);
        return first;
    };
    return setup;
}

} // namespace taut::impl

namespace taut
{

template <class Element>
session<Element>::session(queue& q, const mesh<Element>& m, const parameterize_params& params,
                          const run_limits& limits) requires std::same_as<Element, triangle>
    : body_(std::make_unique<impl::session_run<Element>>(q, impl::map_setup(q, m, params, limits)))
{
}

template session<triangle>::session(queue&, const mesh<triangle>&, const parameterize_params&, const run_limits&);

std::ostream& operator<<(std::ostream& out, const session_report& r)
{
    if (r.outcome != outcome::valid) return out << "no valid map: " << r.reason;
    out << "E " << r.energy << (r.converged ? ", converged, " : ", not converged, ") << r.steps << " steps, ";
    if (!r.pins_held && r.farthest >= 0) out << "pin of vertex " << r.farthest << ' ' << r.distance << " away, ";
    return out << r.flips.flipped << " of " << r.flips.elements << " inverted";
}

} // namespace taut
