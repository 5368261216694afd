// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/queue.hpp>

#include "shared/build_elsewhere.hpp"
#include "shared/own_kernels.hpp"

namespace taut::tools
{

/// The queue on the device that was asked for; empty: TAUT_DEVICE, or the library's choice. Throws no_device.
inline queue open_queue(const std::string& device, bool need_double)
{
    const device_requirements needs{.fp64 = need_double};
    const auto chosen = device.empty() ? find_device(needs) : find_device(device, needs, "--device ");
    require_own_kernels(chosen);
    return queue(chosen, {.build_elsewhere = build_elsewhere(chosen, device)});
}

} // namespace taut::tools
