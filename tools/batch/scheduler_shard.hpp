// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "batch/job.hpp"

namespace taut::tools::batch
{

/// The part of the jobs that is this process's, by the variables that schedulers set: the task of an array (SLURM, Grid
/// Engine, AWS Batch; Kubernetes, whose manifest must set JOB_COMPLETIONS), and in it the process of several (srun,
/// mpirun). None where no variable says so.
/// variable: the value of an environment variable, or null
/// Throws usage_error for variables that are no numbers, or out of their range.
std::optional<shard> scheduler_shard(const std::function<const char*(const char* name)>& variable);

} // namespace taut::tools::batch
