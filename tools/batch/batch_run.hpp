// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "../child.hpp"
#include "job.hpp"
#include "result.hpp"

namespace taut::tools::batch
{

struct run_options
{
    std::size_t at_once = 1;
    bool resume = false;          ///< jobs whose results stand are left out
    bool retry = false;           ///< but for those that failed
    limits bounds;                ///< of jobs that have none of their own
    std::filesystem::path caches; ///< of compiled kernels
};

/// How far a run is.
struct tally
{
    std::size_t jobs = 0, skipped = 0, done = 0, failed = 0, running = 0;
    std::size_t failed_before = 0; ///< of those skipped
};

/// Runs jobs, each in a process of its own, and appends a result for each as it ends.
/// tell: how far it is, from time to time
/// Interrupted, it asks the jobs at work to end and waits for them; they get no result. Throws io_error if a result
/// cannot be written, and std::system_error if no process can be made.
tally run_jobs(const std::vector<job>& jobs, result_file& results, const run_options& options,
               const std::function<void(const tally&)>& tell);

} // namespace taut::tools::batch
