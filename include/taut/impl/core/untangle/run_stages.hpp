// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <taut/impl/core/untangle/stage.hpp>
#include <taut/untangle.hpp>

namespace taut::impl
{

/// Runs stages alternately until the state is injective, has a proof that no map is, or no stage can continue. Returns
/// the name of the one that found the map, or nothing.
template <class Element>
std::string run_stages(untangle_state<Element>& state, const untangle_stages<Element>& stages,
                       const untangle_params& params)
{
    std::vector<char> exhausted(stages.size(), 0);
    int iterations = params.tuning.first_round;
    for (int round = 0; round < params.rounds; ++round)
    {
        for (std::size_t s = 0; s < stages.size(); ++s)
        {
            if (exhausted[s]) continue;
            exhausted[s] = !stages[s]->run(state, iterations);
            const char* stop = state.injective()   ? "injective"
                               : state.proof()     ? "infeasible"
                               : state.cancelled() ? "user"
                               : state.stopped()   ? "time"
                               : exhausted[s]      ? "exhausted"
                                                   : "iterations";
            state.ended(std::string(stages[s]->name()), stop);
            if (state.injective()) return std::string(stages[s]->name());
            if (state.proof() || state.stopped()) return {};
        }
        iterations = std::min(iterations, std::numeric_limits<int>::max() / 2) * 2;
    }
    return {};
}

} // namespace taut::impl
