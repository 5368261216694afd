// SPDX-License-Identifier: MIT
#pragma once

#include <locale>
#include <utility>

#include <taut/solve_params.hpp>

namespace taut::solve::impl
{

/// Two runs as one, of which the second went on where the first had ended.
inline report joined(report first, report next)
{
    for (auto it = next.history.empty() ? next.history.end() : next.history.begin() + 1; it != next.history.end(); ++it)
    {
        auto& entry = first.history.emplace_back(*it);
        entry.iteration += first.iterations;
        entry.evaluations += first.evaluations;
        entry.seconds += first.seconds;
        entry.waits += first.waits;
    }
    next.history = std::move(first.history);
    next.iterations += first.iterations;
    next.evaluations += first.evaluations;
    next.gradients += first.gradients;
    next.products += first.products;
    next.eliminations += first.eliminations;
    next.restarts += first.restarts;
    next.skipped_pairs += first.skipped_pairs;
    next.seconds += first.seconds;
    next.waits += first.waits;
    next.value_start = first.value_start;
    return next;
}

} // namespace taut::solve::impl
