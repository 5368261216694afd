// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <taut/queue.hpp>

namespace bench
{

/// An iterate of a solver.
struct sample
{
    int iteration = 0;
    double value = 0;       ///< mean symmetric Dirichlet energy, by rest area
    double seconds = 0;     ///< since the file was opened, all set-up included, less start-up of the device
    double cpu_seconds = 0; ///< of all threads meanwhile; 0: not counted
};

/// Wall-clock seconds, each counted once.
struct phases
{
    double read = 0;      ///< file to mesh
    double device = 0;    ///< kernel builds and their first launches
    double hierarchy = 0; ///< coarse meshes and the prolongations between them
    double start = 0;     ///< start map; of a nested solver all that happens on coarser levels
    double other = 0;     ///< all other set-up, and the certificate at the end
    double solve = 0;     ///< minimisation

    double before_solve() const { return read + hierarchy + start + other; }
    double total() const { return before_solve() + solve; }
};

/// One run of one solver from a file to a map.
struct solver_run
{
    std::vector<sample> history;
    phases seconds;
    double cpu_seconds = 0; ///< of all threads of the process
    int iterations = 0;     ///< on the mesh itself
    int evaluations = 0;    ///< values computed
    double energy = std::numeric_limits<double>::infinity();
    bool valid = false; ///< there is a map; if not, `stop` says why and there is no history
    std::size_t flipped = 0;
    std::string stop;                         ///< why it ended
    bool limited = false;                     ///< by the time limit
    taut::queue_counters counters;            ///< of a solver on the device
    std::optional<std::uint64_t> bytes_moved; ///< by the element kernels, at least
    std::size_t peak_bytes = 0, bytes_before = 0;
};

/// When a run may end early.
struct run_limits
{
    double seconds = std::numeric_limits<double>::infinity();
    double enough = -std::numeric_limits<double>::infinity(); ///< energy that is low enough
};

/// A row of the table.
struct solver
{
    std::string name;
    bool own_stop = false; ///< runs until its own tests stop it, not until the energy is low enough
    std::function<solver_run(const std::filesystem::path&, const run_limits&)> run;
};

/// Effort until the energy was within a relative error of the best.
struct reached
{
    int iterations;
    double seconds;
    double cpu_seconds = 0; ///< 0: not counted
};

inline std::optional<reached> effort(const solver_run& run, double best, double error)
{
    for (const sample& s : run.history)
        if (s.value - best <= error * best) return reached{s.iteration, s.seconds, s.cpu_seconds};
    return std::nullopt;
}

/// The middle of some numbers, the lower one of two; none of none.
template <class T>
std::optional<T> median(std::vector<T> values)
{
    if (values.empty()) return std::nullopt;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// The median of a figure over runs.
template <class Figure>
auto median_of(const std::vector<solver_run>& runs, Figure&& figure)
{
    std::vector<decltype(figure(runs.front()))> values;
    for (const auto& r : runs) values.push_back(figure(r));
    return *median(std::move(values));
}

} // namespace bench
