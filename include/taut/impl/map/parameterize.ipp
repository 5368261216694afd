// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/map/parameterize.hpp>

#include <taut/impl/map/mapped.hpp>

namespace taut
{

map_result parameterize(queue& q, const mesh<triangle>& m, const parameterize_params& params, const run_limits& limits)
{
    limits.validate();
    const parameterize_params wanted = impl::validated(params);
    const impl::queue_counters before = q.counters();
    impl::run_clock clock(limits.time_limit, limits.observer);
    map_result result = impl::mapped(q, impl::run_surface(m, wanted), wanted, clock);
    result.report.counters = impl::counted_since(before, q.counters());
    return result;
}

} // namespace taut
