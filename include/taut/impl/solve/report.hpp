// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/solve/stop.hpp>

#include <cstdint>
#include <locale>
#include <ostream>
#include <sstream>
#include <utility>
#include <vector>

namespace taut::solve::impl
{

/// Record of one accepted iterate; number 0 is the start.
struct history_entry
{
    int iteration = 0;
    double value = 0;        ///< f(x)
    double gradient = 0;     ///< relative norm of the gradient
    double step = 0;         ///< a in x + a d: 1 is the full step of the method
    bool capped = false;     ///< the barrier cut the step
    int evaluations = 0;     ///< values computed so far
    double seconds = 0;      ///< since the start of the run
    std::uint64_t waits = 0; ///< host waits for a device, since the start of the run
};

} // namespace taut::solve::impl

namespace taut::solve
{

/// Report of a minimisation. Values in the history never increase by more than the rounding error of a value.
struct report
{
    solve::stop stop = solve::stop::iterations;
    int iterations = 0;       ///< accepted steps
    int evaluations = 0;      ///< values computed, those that came with a gradient included
    int gradients = 0;        ///< gradients computed
    int eliminations = 0;     ///< iterations after which parts were minimised by themselves (Newton's method)
    int products = 0;         ///< Hessian products, nearly all with a preconditioning (Newton's method)
    int restarts = 0;         ///< times the method discarded its memory of earlier steps
    int skipped_pairs = 0;    ///< steps without positive curvature, left out of the quasi-Newton memory
    double value_start = 0;   ///< f at the start
    double value = 0;         ///< f at the end
    double gradient_norm = 0; ///< relative norm of the gradient at the end
    double seconds = 0;       ///< wall-clock seconds of the whole run
    std::uint64_t waits = 0;  ///< host waits for a device (Newton's method)
    std::vector<int> capping; ///< parts of the problem whose barrier cut the last step of Newton's method, if one did
    std::vector<impl::history_entry> history;
};

} // namespace taut::solve

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

namespace taut::solve
{

/// One line: `stop: gradient, 7 iterations, E 34.5 -> 7.446`.
inline std::ostream& operator<<(std::ostream& stream, const report& r)
{
    std::ostringstream line; // so that the user's stream keeps its format, and its locale has no say
    line.imbue(std::locale::classic());
    line.precision(4);
    line << "stop: " << r.stop << ", " << r.iterations << (r.iterations == 1 ? " iteration" : " iterations") << ", E "
         << r.value_start << " -> " << r.value;
    return stream << line.str();
}

} // namespace taut::solve
