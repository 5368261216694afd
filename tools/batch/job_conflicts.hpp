// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "batch/job.hpp"

namespace taut::tools::batch
{

/// Jobs of a manifest run at once, in parts of it, and again: throws usage_error if one of them would write a file that
/// another one writes or reads, by whatever name.
/// manifest: named in messages
void require_own_files(const std::vector<job>& jobs, const std::string& manifest);

} // namespace taut::tools::batch
