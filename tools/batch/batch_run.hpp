// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "batch/job.hpp"
#include "batch/job_conflicts.hpp"
#include "batch/result.hpp"
#include "shared/child.hpp"

namespace taut::tools::batch
{

struct run_options
{
    std::size_t at_once = 1;
    bool resume = false;              ///< jobs whose results stand are left out
    bool retry = false;               ///< but for those that failed
    limits bounds;                    ///< of jobs that have none of their own
    std::filesystem::path caches;     ///< of compiled kernels
    batch_files own;                  ///< that no job may write
    bool from_standard_input = false; ///< jobs come by standard input while others run, until it ends
};

/// Progress of a run.
struct tally
{
    std::size_t jobs = 0, skipped = 0, done = 0, failed = 0, running = 0;
    std::size_t failed_before = 0; ///< of those skipped
};

/// As many of the jobs at once that are wanted as this process may open files for, having raised that limit as far as
/// it may; perhaps none.
std::size_t most_jobs_at_once(std::size_t wanted);

/// Runs jobs, each in a process of its own, and appends a result for each as it ends.
/// tell: how far it is, from time to time
/// A line of standard input that is no job has a result of code 3, a job that would write what the batch itself reads
/// or writes one of code 2, and neither ends the run. Where the system refuses one more process, it goes on with those
/// it has. Interrupted, it asks the jobs at work to end and waits for them; they get no result. Throws io_error if a
/// result cannot be written, and usage_error if not even one job can be started.
tally run_jobs(const std::vector<job>& jobs, result_file& results, const run_options& options,
               const std::function<void(const tally&)>& tell);

} // namespace taut::tools::batch
