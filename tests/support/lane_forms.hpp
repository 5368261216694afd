// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <taut/impl/core/compute/choose_device.hpp>
#include <taut/impl/core/compute/lane_form.hpp>

namespace taut::test
{

/// The forms of kernels that the device of the tests can take: a CPU both, but for the host, which has those for CPUs
/// alone; a GPU its own; that for CPUs keeps hundreds of kilobytes an item there.
inline std::vector<impl::lane_form> lane_forms()
{
    if (find_device().is_host()) return {{16, 16}};
    if (find_device().is_cpu()) return {{16, 16}, {32, 1}};
    return {{32, 1}};
}

} // namespace taut::test
