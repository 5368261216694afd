// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>

#include <taut/impl/compute/cl.hpp>

namespace taut
{

/// An OpenCL device: a small copyable handle with its properties read once.
class device
{
public:
    /// Wraps a device of the user's; a sub-device must outlive it.
    explicit device(cl_device_id id);

    const std::string& name() const noexcept { return name_; }
    const std::string& vendor() const noexcept { return vendor_; }
    const std::string& driver_version() const noexcept { return driver_version_; }
    const std::string& platform() const noexcept { return platform_; }
    /// OpenCL version as 100 * major + 10 * minor: 120, 200, 300.
    int opencl_version() const noexcept { return opencl_version_; }

    bool is_gpu() const noexcept { return (type_ & CL_DEVICE_TYPE_GPU) != 0; }
    bool is_cpu() const noexcept { return (type_ & CL_DEVICE_TYPE_CPU) != 0; }
    bool has_fp64() const noexcept { return has_fp64_; }
    bool available() const noexcept { return available_; }
    bool has_compiler() const noexcept { return has_compiler_; }

    std::size_t compute_units() const noexcept { return compute_units_; }
    /// Largest clock frequency in MHz as the driver tells it; 0 if it does not.
    std::size_t clock() const noexcept { return clock_; }
    /// Bytes of global memory and the largest single buffer in bytes.
    std::uint64_t global_memory() const noexcept { return global_memory_; }
    std::uint64_t max_allocation() const noexcept { return max_allocation_; }
    std::size_t max_group() const noexcept { return max_group_; }

    /// The same device as if it had no double precision, or less memory: for tests, and to rehearse a weaker machine.
    device without_fp64() const
    {
        device d = *this;
        d.has_fp64_ = false;
        return d;
    }
    device with_memory(std::uint64_t global, std::uint64_t largest) const
    {
        device d = *this;
        d.global_memory_ = global;
        d.max_allocation_ = largest;
        return d;
    }
    /// The same device as if it were a GPU and nothing else: kernels take the forms that GPUs get.
    device as_gpu() const
    {
        device d = *this;
        d.type_ = CL_DEVICE_TYPE_GPU;
        return d;
    }

    cl_device_id native() const noexcept { return id_; }
    cl_platform_id native_platform() const noexcept { return platform_id_; }
    /// "NAME, driver VERSION", as error messages quote it.
    std::string label() const { return name_ + ", driver " + driver_version_; }

    friend bool operator==(const device& a, const device& b) { return a.native() == b.native(); }
    friend std::ostream& operator<<(std::ostream& out, const device& d);

private:
    cl_device_id id_ = nullptr;
    cl_platform_id platform_id_ = nullptr;
    std::string name_, vendor_, driver_version_, platform_;
    cl_device_type type_ = 0;
    bool has_fp64_ = false, available_ = false, has_compiler_ = false;
    std::size_t compute_units_ = 0, clock_ = 0, max_group_ = 0;
    std::uint64_t global_memory_ = 0, max_allocation_ = 0;
    int opencl_version_ = 0;
};

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/compute/device.ipp>
#endif
