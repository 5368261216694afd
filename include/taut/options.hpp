// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_OPTIONS_HPP
#define TAUT_OPTIONS_HPP

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <taut/errors.hpp>
#include <taut/types.hpp>

/// Common types of all entry points: limits of a run, progress and cancellation, precision, reports of stages.
namespace taut
{

/// Progress of a run.
struct progress
{
    int iteration = 0;           ///< accepted steps so far
    double value = 0;            ///< f at the current iterate
    double gradient = 0;         ///< its relative gradient
    double step = 0;             ///< the last accepted step
    int evaluations = 0;         ///< values computed so far
    double seconds = 0;          ///< since the start
    int level = 0;               ///< level of a nested iteration; 0: the problem itself
    std::string_view stage = {}; ///< of a call of several stages: of make_atlas() "charts", "flatten" or "pack"
    bool iterate =
        true; ///< a new iterate; false: in the middle of a line search, the other fields are the last iterate's
    bool usable = true; ///< a run that ends now has a result; false where one of several phases has none yet
    /// Current map, one point per vertex in the user's order and lengths, for a live view: as valid as the result, but
    /// not certified. Empty where there is no map of the whole surface. A call costs a download; to be called by the
    /// observer only.
    std::function<std::vector<vec2>()> coordinates = {};
    /// Current shape of a volume, in the same way.
    std::function<std::vector<vec3>()> positions = {};
};

/// Callback at every iterate and after every evaluation of a line search. Returning false ends the run with the best
/// iterate so far (solve::stop::user). It runs on the thread of the solver; an exception passes through.
using observer = std::function<bool(const progress&)>;

/// Limits of a run, the same for all entry points. A run that reaches one ends with the best valid result so far, or
/// with none, which its outcome says.
struct run_limits
{
    /// Wall-clock seconds of the whole call, as 5s or 50ms (std::chrono_literals). Range >= 0.
    std::chrono::duration<double> time_limit = std::chrono::duration<double>(std::numeric_limits<double>::infinity());

    /// Asked at every iterate and trial step, between phases and between the steps of long ones: false ends the run.
    /// It runs on the thread that called; an exception passes through.
    taut::observer observer = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (!(time_limit.count() >= 0)) throw parameter_error("time_limit", "must not be negative");
    }
};

/// Arithmetic of the optimisation. Certificates are exact in any case.
enum class precision
{
    automatic, ///< mixed for methods with multigrid, and fp64 from there on if that did not converge; fp64 for others
    fp64,      ///< positions, elements and vectors in double
    mixed,     ///< positions in double, differences cast to float, elements and vectors in float, sums in double
    fp32       ///< everything in float, sums in double where the device has it: reaches relative gradients near 1e-5
};

/// Report of one stage of a run: a start, a reinsertion, a minimisation, on one level. docs/reference/maps.md has their
/// names.
struct stage_report
{
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();

    std::string stage;           ///< its name
    std::size_t level = 0;       ///< 0: the mesh itself
    std::size_t vertices = 0;    ///< vertices of the level
    int iterations = 0;          ///< accepted steps
    double energy_before = none; ///< objective of the stage, a mean over the elements of the level; NaN: it has none
    double energy_after = none;
    double seconds = 0;        ///< wall clock, from the end of the stage before to that of this one
    std::string stop = {};     ///< reason for its end; empty: its work was done
    int steps_cut = 0;         ///< steps that elements about to flip made shorter, or, in an untangling, any others
    std::vector<idx> cut_by{}; ///< the corners of the elements that cut the last step, the user's numbers, each once
    double step_median = none; ///< median length of its steps; 1: the full step of the method
};

/// Counts of what a queue has done since its construction: host waits dominate costs, then launches.
struct queue_counters
{
    std::uint64_t launches = 0;      ///< kernels enqueued
    std::uint64_t waits = 0;         ///< times the host blocked: reads, writes, finish
    std::uint64_t bytes_read = 0;    ///< device to host
    std::uint64_t bytes_written = 0; ///< host to device
    std::uint64_t builds = 0;        ///< programs compiled
    double build_seconds = 0;        ///< host seconds spent compiling them
};

} // namespace taut

#endif
#include <taut/impl/leave.inl>
