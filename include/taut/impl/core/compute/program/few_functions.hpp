// SPDX-License-Identifier: MIT
#pragma once

namespace taut::impl
{

/// Begins the options of programs that call no functions of OpenCL C but those that kernels/functions.cl declares.
inline constexpr const char* few_functions = "-DFEW_FUNCTIONS ";

} // namespace taut::impl
