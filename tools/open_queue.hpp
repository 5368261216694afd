// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <string>

#include <taut/compute/queue.hpp>

namespace taut::tools
{

/// The queue on the device that was asked for; empty: the library's choice. Throws no_device.
inline queue open_queue(const std::string& device, bool need_double)
{
    // TAUT_DEVICE is how the library takes a wish; --device is the same thing, said louder.
    if (!device.empty()) ::setenv("TAUT_DEVICE", device.c_str(), 1);
    return queue(choose_device({.fp64 = need_double}));
}

} // namespace taut::tools
