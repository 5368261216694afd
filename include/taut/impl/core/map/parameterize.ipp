// SPDX-License-Identifier: MIT
#pragma once

#include <ostream>
#include <string>

#include <taut/impl/core/compute/queue_counters.hpp>
#include <taut/impl/core/map/mapped.hpp>
#include <taut/parameterize.hpp>
#include <taut/untangle.hpp>

namespace taut
{

map_result parameterize(queue& q, const mesh<triangle>& m, const parameterize_params& params, const run_limits& limits)
{
    limits.validate();
    const parameterize_params wanted = impl::validated(params);
    const queue_counters before = q.counters();
    impl::run_clock clock(limits.time_limit, limits.observer);
    map_result result = impl::mapped(q, impl::run_surface(m, wanted), wanted, clock);
    result.report.counters = impl::counted_since(before, q.counters());
    return result;
}

std::ostream& operator<<(std::ostream& out, const map_report& r)
{
    if (r.outcome != outcome::valid) return out << "no valid map: " << r.reason;
    return out << r.solve << ", " << std::to_string(r.flips.flipped) << " of " << std::to_string(r.flips.elements)
               << " flipped";
}

} // namespace taut
