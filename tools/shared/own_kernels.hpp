// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include <taut/device.hpp>

namespace taut::tools
{

/// Folder of PoCL's kernel cache; empty where the environment names none, and PoCL takes one that is everybody's.
std::filesystem::path kernels_of_pocl();

/// Throws usage_error if the compiled kernels that the device's driver would load may be somebody else's: they run as
/// this user.
void require_own_kernels(const taut::device& device);

} // namespace taut::tools
