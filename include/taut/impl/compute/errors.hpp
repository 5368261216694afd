// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/impl/core/error.hpp>

namespace taut
{

/// Error: no OpenCL device meets the requirements. The text lists every platform and device seen, why each was refused,
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

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/compute/errors.ipp>
#endif
