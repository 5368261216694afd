// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_COMPUTE
#endif
#ifndef TAUT_DEVICE_HPP
#define TAUT_DEVICE_HPP

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/compute/cl.hpp>

/// Devices: the host and those of OpenCL, the choice among them, and their errors.
///
///     const device best = find_device();                   // the one that TAUT_DEVICE names, else the best
///     const device gpu = find_device("NVIDIA", {.fp64 = true});
///     for (const auto& [d, refusal] : devices()) std::cout << d << (refusal.empty() ? "" : ": " + refusal) << '\n';
namespace taut
{

/// A device of OpenCL, or the host itself: a small copyable handle with its properties read once.
class device
{
public:
    /// The properties of a device.
    struct facts
    {
        enum class kind
        {
            gpu,
            cpu,
            other
        };

        cl_device_id id = nullptr; ///< null: the host
        cl_platform_id platform_id = nullptr;
        std::string name, vendor, driver_version, platform;
        facts::kind type = facts::kind::other;
        bool has_fp64 = false, available = false, has_compiler = false;
        std::size_t compute_units = 0, clock = 0, max_group = 0;
        std::uint64_t global_memory = 0, max_allocation = 0; ///< in bytes
        int opencl_version = 0;
    };

    /// Wraps a device of the user's; a sub-device must outlive it. Throws device_error.
    explicit device(cl_device_id id);
    explicit device(facts known) : facts_(std::move(known)) {}

    /// The threads of this process, which need no driver and compile nothing.
    static device host();
    bool is_host() const noexcept { return !facts_.id; }

    const std::string& name() const noexcept { return facts_.name; }
    const std::string& vendor() const noexcept { return facts_.vendor; }
    const std::string& driver_version() const noexcept { return facts_.driver_version; }
    const std::string& platform() const noexcept { return facts_.platform; }
    /// OpenCL version as 100 * major + 10 * minor: 120, 200, 300; 0 of the host.
    int opencl_version() const noexcept { return facts_.opencl_version; }

    bool is_gpu() const noexcept { return facts_.type == facts::kind::gpu; }
    bool is_cpu() const noexcept { return facts_.type == facts::kind::cpu; }
    bool has_fp64() const noexcept { return facts_.has_fp64; }
    bool available() const noexcept { return facts_.available; }
    bool has_compiler() const noexcept { return facts_.has_compiler; }

    std::size_t compute_units() const noexcept { return facts_.compute_units; }
    /// Largest clock frequency in MHz as the driver tells it; 0 if it does not.
    std::size_t clock() const noexcept { return facts_.clock; }
    /// Bytes of global memory and the largest single buffer in bytes.
    std::uint64_t global_memory() const noexcept { return facts_.global_memory; }
    std::uint64_t max_allocation() const noexcept { return facts_.max_allocation; }
    std::size_t max_group() const noexcept { return facts_.max_group; }

    /// The same device as if it had no double precision, or less memory: for tests, and to rehearse a weaker machine.
    device without_fp64() const
    {
        device d = *this;
        d.facts_.has_fp64 = false;
        return d;
    }
    device with_memory(std::uint64_t global, std::uint64_t largest) const
    {
        device d = *this;
        d.facts_.global_memory = global;
        d.facts_.max_allocation = largest;
        return d;
    }
    /// The same device as if it were a GPU and nothing else: kernels take the forms that GPUs get.
    device as_gpu() const
    {
        device d = *this;
        d.facts_.type = facts::kind::gpu;
        return d;
    }

    /// Null of the host.
    cl_device_id native() const noexcept { return facts_.id; }
    cl_platform_id native_platform() const noexcept { return facts_.platform_id; }
    /// "NAME, driver VERSION", as error messages quote it.
    std::string label() const { return name() + (is_host() ? ", taut " : ", driver ") + driver_version(); }

    friend bool operator==(const device& a, const device& b) { return a.native() == b.native(); }
    friend std::ostream& operator<<(std::ostream& out, const device& d);

private:
    facts facts_;
};

/// Requirements on a device.
struct device_requirements
{
    bool fp64 = false;        ///< double precision is a must; without it fp64 is only preferred
    std::uint64_t memory = 0; ///< bytes of global memory
};

/// A device of this machine, and the reason why it does not meet the requirements; empty: it does.
struct listed_device
{
    taut::device device;
    std::string refusal;
};

/// Every device of every platform, in the order of the driver loader: TAUT_DEVICE counts them in this order, from 0.
std::vector<listed_device> devices(const device_requirements& needs = {});

/// The device that a wish names: an index into devices(), or a part of a device's, vendor's or platform's name, in any
/// case. Of several that fit, the best one: double precision before none, then GPU before CPU, then the largest. For an
/// empty wish a GPU with double precision, else the host: other OpenCL devices are taken by name alone. With
/// TAUT_FORM=gpu it is taken for a GPU. said: the words before the wish in the message of no_device, as "--device ".
/// Throws no_device if none fits.
device find_device(const std::string& wish, const device_requirements& needs = {},
                   const std::string& said = "the wish ");

/// The device that TAUT_DEVICE names if it is set, else a GPU with double precision, else the host.
device find_device(const device_requirements& needs = {});

/// Error: no device meets the requirements. The text lists every platform and device seen, why each was refused,
/// and the remedy.
class no_device : public error
{
public:
    using error::error;
};

/// Error of an OpenCL call that failed, or would fail silently later (an allocation beyond the device's limits, a
/// double kernel on a device without fp64). code() is the OpenCL error number, 0 where the library refused before
/// calling the driver.
class device_error : public error
{
public:
    device_error(std::string operation, const std::string& reason, std::string device, int code = 0);

    const std::string& operation() const noexcept { return operation_; }
    /// Name and driver version of the device.
    const std::string& device() const noexcept { return device_; }
    int code() const noexcept { return code_; }

private:
    std::string operation_;
    std::string device_;
    int code_;
};

/// Error of a kernel that the device's compiler refused: its name, the compiler's log, and the numbered source around
/// the lines that the log names.
class build_error : public device_error
{
public:
    build_error(std::string kernel, std::string log, std::string excerpt, const std::string& device, int code);

    const std::string& kernel() const noexcept { return kernel_; }
    const std::string& log() const noexcept { return log_; }
    const std::string& excerpt() const noexcept { return excerpt_; }

private:
    std::string kernel_;
    std::string log_;
    std::string excerpt_;
};

} // namespace taut

#endif
#include <taut/impl/leave.inl>
