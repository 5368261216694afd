// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/device.hpp>

namespace taut::impl
{

/// Why d does not meet the needs, in words; empty if it does.
std::string device_refusal(const device& d, const device_requirements& needs = {});

} // namespace taut::impl
