// SPDX-License-Identifier: MIT
#pragma once

#include <taut/map/parameterize.hpp>

#include <taut/map/detail/mapped.hpp>

namespace taut
{

map_result parameterize(queue& q, const mesh<triangle>& m, const parameterize_params& params)
{
    const parameterize_params wanted = detail::validated(params);
    const queue_counters before = q.counters();
    detail::run_clock clock(wanted.time_limit, wanted.observer);
    map_result result = detail::mapped(q, detail::run_surface(m, wanted), wanted, clock);
    result.report.counters = counted_since(before, q.counters());
    return result;
}

} // namespace taut
