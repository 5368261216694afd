// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/compute/device.hpp>
#include <taut/impl/compute/opencl.hpp>

namespace taut::impl
{

inline std::string trimmed(const std::string& text)
{
    const auto first = text.find_first_not_of(" \t\n");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

} // namespace taut::impl

namespace taut
{

device::device(cl_device_id id) : id_(id)
{
    const boost::compute::device handle(id);
    platform_id_ = handle.platform().id();
    name_ = impl::trimmed(handle.name());
    vendor_ = impl::trimmed(handle.vendor());
    driver_version_ = impl::trimmed(handle.driver_version());
    platform_ = impl::trimmed(handle.platform().name());
    type_ = handle.type();
    has_fp64_ = handle.get_info<cl_device_fp_config>(CL_DEVICE_DOUBLE_FP_CONFIG) != 0;
    available_ = handle.get_info<cl_bool>(CL_DEVICE_AVAILABLE) != 0;
    has_compiler_ = handle.get_info<cl_bool>(CL_DEVICE_COMPILER_AVAILABLE) != 0;
    compute_units_ = handle.compute_units();
    clock_ = handle.clock_frequency();
    max_group_ = handle.get_info<std::size_t>(CL_DEVICE_MAX_WORK_GROUP_SIZE);
    global_memory_ = handle.global_memory_size();
    max_allocation_ = handle.max_memory_alloc_size();
    // "OpenCL 1.2 whatever the vendor likes to add"
    const std::string version = handle.version();
    if (version.size() > 9 && version.compare(0, 7, "OpenCL ") == 0)
        opencl_version_ = 100 * (version[7] - '0') + 10 * (version[9] - '0');
}

std::ostream& operator<<(std::ostream& out, const device& d)
{
    return out << d.name_ << " ("
               << (d.is_gpu()   ? "GPU"
                   : d.is_cpu() ? "CPU"
                                : "accelerator")
               << ", " << d.platform_ << ", driver " << d.driver_version_ << (d.has_fp64_ ? "" : ", no fp64") << ')';
}

} // namespace taut
