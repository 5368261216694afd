// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include <taut/device.hpp>
#include <taut/impl/core/compute/drivers.hpp>

namespace taut::impl
{

[[noreturn]] inline void refuse_opencl(const char* operation)
{
    throw device_error(operation, "this build of taut is without OpenCL (TAUT_WITH_OPENCL)", "none");
}

std::vector<opencl_platform> opencl_platforms()
{
    return {};
}
std::vector<device> opencl_devices(const opencl_platform&, bool)
{
    return {};
}
device::facts opencl_facts(cl_device_id)
{
    refuse_opencl("wrapping a device of OpenCL");
}
device opencl_device_of(cl_context)
{
    refuse_opencl("adopting a context");
}
device opencl_device_of(cl_command_queue)
{
    refuse_opencl("adopting a command queue");
}
std::unique_ptr<device_commands> open_opencl(const device&, const opencl_opening&)
{
    refuse_opencl("opening a queue");
}

} // namespace taut::impl
