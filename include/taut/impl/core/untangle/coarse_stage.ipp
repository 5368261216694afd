// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <taut/impl/core/untangle/coarse_stage.hpp>

namespace taut::impl
{

bool coarse_stage::run(untangle_state<triangle>& state, int)
{
    const auto& problem = state.problem();
    if (problem.rest.points().size() <= fewest) return false;
    std::optional<hierarchy<triangle>> h;
    try
    {
        h = levels_of(problem, [&state] { return state.proceed(0); });
    }
    catch (const mesh_error&) // no surface that can be thinned
    {
        return false;
    }
    std::size_t l = 1;
    while (l + 1 < h->levels.size() && h->levels[l].vertices.size() > fewest) ++l;
    for (int steps = 45; l > 0 && l < h->levels.size() && h->levels[l].vertices.size() <= most; --l, steps *= 2)
    {
        if (auto uv = untangled(state, *h, l, steps)) raise(state, *h, l, std::move(*uv));
        if (state.injective() || state.stopped()) break;
    }
    return false;
}

untangle_stages<triangle> coarse_stage::stages(bool outline_pinned)
{
    untangle_stages<triangle> chosen;
    if (!outline_pinned)
    {
        chosen.push_back(std::make_unique<pull_stage>(pull_stage_params{"pull"}));
        return chosen;
    }
    chosen.push_back(std::make_unique<harmonic_stage<triangle>>());
    chosen.push_back(std::make_unique<newton_stage<triangle>>());
    return chosen;
}

} // namespace taut::impl
