// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <taut/errors.hpp>
#include <taut/recording.hpp>

namespace taut::impl
{

/// Recorded kernels as the source of one program: first the directives and helper functions of all of them, each once,
/// then the kernels in their order. Throws parameter_error for two kernels of one name.
std::string joined_source(const std::vector<kernel_text>& texts);

} // namespace taut::impl
