// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>

#include <taut/device.hpp>

namespace taut::impl
{

/// PoCL compiles for the processor that LLVM finds, and LLVM finds none that is newer than itself.
inline std::string told_by_compiler(const std::string& log, const std::string& excerpt)
{
    if (log.find("unknown target CPU") != std::string::npos)
        return "the driver's compiler is older than this processor, and does not know it; install a newer driver\n" +
               log;
    if (excerpt.empty()) return log; // there is no compiler
    return "the compiler says\n" + log + excerpt;
}

} // namespace taut::impl

namespace taut
{

device_error::device_error(std::string operation, const std::string& reason, std::string device, int code)
    : error(operation + ": " + reason + " [device " + device + "]"),
      operation_(std::move(operation)),
      device_(std::move(device)),
      code_(code)
{
}

build_error::build_error(std::string kernel, std::string log, std::string excerpt, const std::string& device, int code)
    : device_error("building kernel " + kernel, impl::told_by_compiler(log, excerpt), device, code),
      kernel_(std::move(kernel)),
      log_(std::move(log)),
      excerpt_(std::move(excerpt))
{
}

} // namespace taut
