// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include <taut/impl/compute/errors.hpp>

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
    : device_error("building kernel " + kernel, "the compiler says\n" + log + excerpt, device, code),
      kernel_(std::move(kernel)),
      log_(std::move(log)),
      excerpt_(std::move(excerpt))
{
}

} // namespace taut
