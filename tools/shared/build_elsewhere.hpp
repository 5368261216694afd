// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/queue.hpp>

namespace taut::tools
{

/// For queue_options::build_elsewhere: `taut build-kernels` as a process beside this one, the first time that a program
/// is needed; one at a time. Empty where that is of no use. wish: the device as --device has it, or empty.
///
/// Which programs the driver's cache holds, files beside its kernels say. What they say wrongly costs time alone, and
/// so does a process that fails or takes too long: what it has not built, this one builds. Neither writes a program
/// or a kernel that the other one is building, as PoCL's cache is not safe between processes.
queue_options::builder build_elsewhere(const taut::device& device, const std::string& wish);

} // namespace taut::tools
