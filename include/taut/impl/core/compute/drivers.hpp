// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <taut/device.hpp>
#include <taut/impl/core/compute/commands.hpp>
#include <taut/queue.hpp>

/// 1: OpenCL's devices are there, beside the host. Needs the headers of OpenCL and Boost.Compute; OpenCL's library is
/// opened when it is asked for.
#ifndef TAUT_WITH_OPENCL
#if __has_include(<CL/cl.h>) && __has_include(<boost/compute/system.hpp>)
#define TAUT_WITH_OPENCL 1
#else
#define TAUT_WITH_OPENCL 0
#endif
#endif

namespace taut::impl
{

/// A platform of OpenCL.
struct opencl_platform
{
    cl_platform_id id = nullptr;
    std::string name, version;
};

/// None where there is no OpenCL.
std::vector<opencl_platform> opencl_platforms();

/// Devices of a platform; GPUs alone if they are asked for.
std::vector<device> opencl_devices(const opencl_platform& platform, bool gpus_alone);

/// Throws device_error.
device::facts opencl_facts(cl_device_id id);

/// The devices of a context or of a queue of the user's. Throw device_error.
device opencl_device_of(cl_context context);
device opencl_device_of(cl_command_queue commands);

/// How an OpenCL device is opened: in a context or queue of the user's, if there is one.
struct opencl_opening
{
    cl_context context = nullptr;
    cl_command_queue commands = nullptr;
    bool profiling = false, quick = false;
    queue_options::builder elsewhere = {};
};

/// Throws device_error.
std::unique_ptr<device_commands> open_opencl(const device& d, const opencl_opening& how);

/// Of the host device.
std::unique_ptr<device_commands> open_host(const device& d, bool profiling);

} // namespace taut::impl
