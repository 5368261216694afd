// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/deform.hpp>
#include <taut/impl/core/map/smooth.hpp>
#include <taut/quality.hpp>
#include <taut/smooth.hpp>

namespace taut
{

template <class Element>
smooth_result<Element> smooth(queue& q, const mesh<Element>& given, const smooth_params<Element>& params,
                              const run_limits& limits)
{
    params.validate();
    limits.validate();
    if (!params.owners.empty() && params.targets.size() != given.cells().size())
        throw parameter_error("targets", "one matrix a cell where there are owners");
    if (!params.rest.empty() && params.rest.size() != given.points().size())
        throw parameter_error("rest", std::to_string(params.rest.size()) + " positions for " +
                                          std::to_string(given.points().size()) + " vertices");
    using point = vec<Element::dimension>;
    const int exponent = impl::size_exponent(given.points());
    const mesh<Element> m(impl::times_power(given.points(), -exponent), given.cells());
    auto how = impl::smoothing(params, exponent);
    impl::constrain_smoothing(how, m, params);

    const std::vector<point> start(m.points().begin(), m.points().end());
    smooth_result<Element> result;
    const auto measured = [&](std::span<const point> x)
    {
        return params.owners.empty() ? measure_shapes<Element>(m.cells(), x)
                                     : measure_shapes<Element>(m.cells(), x, params.owners, params.targets);
    };
    result.before = measured(start);
    std::optional<mesh<Element>> other; // at rest, which starts as m
    if (!params.rest.empty())
    {
        other.emplace(impl::times_power(params.rest, -exponent), m.cells());
        how.initial = start;
    }
    auto found =
        deform(q, other ? *other : m, how, {limits.time_limit, impl::in_own_size<Element>(limits.observer, exponent)});
    if (!found.x.empty()) result.after = measured(found.x);
    auto& report = found.report;
    if (report.outcome == outcome::valid)
    {
        // Where rounding ends steps, what they came to may be worse than what was given.
        const bool worse = result.after.worst.mean_ratio < result.before.worst.mean_ratio &&
                           result.after.mean_ratio < result.before.mean_ratio;
        if (worse && !report.converged)
        {
            auto flips = certify<Element::dimension>(m.cells(), std::span<const point>(start), {}, 16, params.owners);
            if (flips)
            {
                found.x = start;
                result.after = result.before;
                report.flips = std::move(flips);
                report.notes.push_back("steps made the mesh worse; it stays as it was");
            }
        }
        if (!report.converged && !report.stopped)
            report.notes.push_back("steps ended before convergence; the result is the best by then");
    }
    result.x = impl::times_power(std::move(found.x), exponent);
    result.report = std::move(found.report);
    result.report.distance = std::ldexp(result.report.distance, exponent);
    return result;
}

template smooth_result<triangle> smooth<triangle>(queue& q, const mesh<triangle>& given,
                                                  const smooth_params<triangle>& params, const run_limits& limits);

template smooth_result<tetrahedron> smooth<tetrahedron>(queue& q, const mesh<tetrahedron>& given,
                                                        const smooth_params<tetrahedron>& params,
                                                        const run_limits& limits);

} // namespace taut
