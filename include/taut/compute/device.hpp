// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>
#include <utility>

#include <taut/compute/detail/opencl.hpp>

namespace taut
{

/// An OpenCL device: a small copyable handle with its properties read once.
class device
{
public:
    /// Wraps a device of the user's. The handle is retained.
    explicit device(cl_device_id id) : device(boost::compute::device(id)) {}

    const std::string& name() const noexcept { return name_; }
    const std::string& vendor() const noexcept { return vendor_; }
    const std::string& driver_version() const noexcept { return driver_version_; }
    const std::string& platform() const noexcept { return platform_; }
    const std::string& platform_version() const noexcept { return platform_version_; }
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

    cl_device_id native() const { return handle_.id(); }
    cl_platform_id native_platform() const { return handle_.platform().id(); }
    /// "NAME, driver VERSION", as error messages quote it.
    std::string label() const { return name_ + ", driver " + driver_version_; }

    friend bool operator==(const device& a, const device& b) { return a.native() == b.native(); }
    friend std::ostream& operator<<(std::ostream& out, const device& d)
    {
        return out << d.name_ << " ("
                   << (d.is_gpu()   ? "GPU"
                       : d.is_cpu() ? "CPU"
                                    : "accelerator")
                   << ", " << d.platform_ << ", driver " << d.driver_version_ << (d.has_fp64_ ? "" : ", no fp64")
                   << ')';
    }

private:
    explicit device(boost::compute::device handle)
        : handle_(std::move(handle)),
          name_(trimmed(handle_.name())),
          vendor_(trimmed(handle_.vendor())),
          driver_version_(trimmed(handle_.driver_version())),
          platform_(trimmed(handle_.platform().name())),
          platform_version_(trimmed(handle_.platform().version())),
          type_(handle_.type()),
          has_fp64_(handle_.get_info<cl_device_fp_config>(CL_DEVICE_DOUBLE_FP_CONFIG) != 0),
          available_(handle_.get_info<cl_bool>(CL_DEVICE_AVAILABLE) != 0),
          has_compiler_(handle_.get_info<cl_bool>(CL_DEVICE_COMPILER_AVAILABLE) != 0),
          compute_units_(handle_.compute_units()),
          clock_(handle_.clock_frequency()),
          max_group_(handle_.get_info<std::size_t>(CL_DEVICE_MAX_WORK_GROUP_SIZE)),
          global_memory_(handle_.global_memory_size()),
          max_allocation_(handle_.max_memory_alloc_size())
    {
        // "OpenCL 1.2 whatever the vendor likes to add"
        const std::string version = handle_.version();
        if (version.size() > 9 && version.compare(0, 7, "OpenCL ") == 0)
            opencl_version_ = 100 * (version[7] - '0') + 10 * (version[9] - '0');
    }

    static std::string trimmed(const std::string& text)
    {
        const auto first = text.find_first_not_of(" \t\n");
        if (first == std::string::npos) return {};
        return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
    }

    boost::compute::device handle_;
    std::string name_, vendor_, driver_version_, platform_, platform_version_;
    cl_device_type type_ = 0;
    bool has_fp64_ = false, available_ = false, has_compiler_ = false;
    std::size_t compute_units_ = 0, clock_ = 0, max_group_ = 0;
    std::uint64_t global_memory_ = 0, max_allocation_ = 0;
    int opencl_version_ = 0;
};

} // namespace taut
