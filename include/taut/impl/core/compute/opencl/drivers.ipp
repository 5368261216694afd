// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>

#include <taut/device.hpp>
#include <taut/impl/core/compute/drivers.hpp>
#include <taut/impl/core/compute/one_process.hpp>
#include <taut/impl/core/compute/opencl/commands.hpp>

namespace taut::impl
{

inline std::string trimmed(const std::string& text)
{
    const auto first = text.find_first_not_of(" \t\n");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

std::vector<opencl_platform> opencl_platforms()
try
{
    if (!opencl_library::find()) return {};
    std::vector<opencl_platform> platforms;
    for (const auto& platform : boost::compute::system::platforms())
        platforms.push_back({platform.id(), trimmed(platform.name()), trimmed(platform.version())});
    return platforms;
}
catch (const boost::compute::opencl_error& e)
{
    throw device_error("listing platforms", e.error_string(), "not opened", e.error_code());
}

std::vector<device> opencl_devices(const opencl_platform& platform, bool gpus_alone)
{
    std::vector<boost::compute::device> found;
    try
    {
        found = boost::compute::platform(platform.id).devices(gpus_alone ? CL_DEVICE_TYPE_GPU : CL_DEVICE_TYPE_ALL);
    }
    catch (const boost::compute::opencl_error&)
    {
        // A platform that cannot be asked has no device; find_device lists it by name.
    }
    std::vector<device> devices;
    for (const auto& handle : found) devices.emplace_back(handle.id());
    return devices;
}

device::facts opencl_facts(cl_device_id id)
try
{
    const boost::compute::device handle(id);
    device::facts d;
    d.id = id;
    d.platform_id = handle.platform().id();
    d.name = trimmed(handle.name());
    d.vendor = trimmed(handle.vendor());
    d.driver_version = trimmed(handle.driver_version());
    d.platform = trimmed(handle.platform().name());
    const cl_device_type type = handle.type();
    // Oclgrind is of all kinds.
    d.type = type & CL_DEVICE_TYPE_CPU   ? device::facts::kind::cpu
             : type & CL_DEVICE_TYPE_GPU ? device::facts::kind::gpu
                                         : device::facts::kind::other;
    d.has_fp64 = handle.get_info<cl_device_fp_config>(CL_DEVICE_DOUBLE_FP_CONFIG) != 0;
    d.available = handle.get_info<cl_bool>(CL_DEVICE_AVAILABLE) != 0;
    d.has_compiler = handle.get_info<cl_bool>(CL_DEVICE_COMPILER_AVAILABLE) != 0;
    d.compute_units = handle.compute_units();
    d.clock = handle.clock_frequency();
    d.max_group = handle.get_info<std::size_t>(CL_DEVICE_MAX_WORK_GROUP_SIZE);
    d.global_memory = handle.global_memory_size();
    d.max_allocation = handle.max_memory_alloc_size();
    // "OpenCL 1.2 whatever the vendor likes to add"
    const std::string version = trimmed(handle.version());
    if (version.size() > 9 && version.compare(0, 7, "OpenCL ") == 0)
        d.opencl_version = 100 * (version[7] - '0') + 10 * (version[9] - '0');
    return d;
}
catch (const boost::compute::opencl_error& e)
{
    throw device_error("asking what a device can do", e.error_string(), "", e.error_code());
}

/// The device of a context or queue of the user's, found to be alive.
template <class Wrap>
device device_of(Wrap&& wrap)
try
{
    return device(wrap().get_device().id());
}
catch (const boost::compute::opencl_error& e)
{
    throw device_error("adopting the user's context or queue", e.error_string(), "", e.error_code());
}

device opencl_device_of(cl_context context)
{
    return device_of([&] { return boost::compute::context(context); });
}

device opencl_device_of(cl_command_queue commands)
{
    return device_of([&] { return boost::compute::command_queue(commands); });
}

/// The user's queue, or one of taut's own.
inline boost::compute::command_queue commands_of(const device& d, const opencl_opening& how,
                                                 const boost::compute::context& context)
{
    if (!how.commands)
        return {context, boost::compute::device(d.native()),
                how.profiling ? cl_command_queue_properties(CL_QUEUE_PROFILING_ENABLE) : 0};
    boost::compute::command_queue adopted(how.commands);
    if (adopted.get_properties() & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE)
        throw device_error("adopting a command queue", "it is out of order; taut relies on the order of commands",
                           d.label());
    return adopted;
}

std::unique_ptr<device_commands> open_opencl(const device& d, const opencl_opening& how)
{
    refuse_fork("opening a queue");
    try
    {
        const auto context = how.commands  ? boost::compute::command_queue(how.commands).get_context()
                             : how.context ? boost::compute::context(how.context)
                                           : boost::compute::context(boost::compute::device(d.native()));
        return std::make_unique<opencl_commands>(d, context, commands_of(d, how, context), how.quick, how.elsewhere);
    }
    catch (const boost::compute::opencl_error& e)
    {
        throw device_error("opening a queue", e.error_string(), d.label(), e.error_code());
    }
}

} // namespace taut::impl
