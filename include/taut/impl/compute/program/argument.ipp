// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/compute/program/argument.hpp>

namespace taut::impl
{

argument argument::as(std::string_view type) const
{
    if (is_memory_ || type_ != "double" || type != "float") return *this;
    double number = 0;
    std::memcpy(&number, bytes_.data(), sizeof number);
    return static_cast<float>(number);
}

void argument::set(const queue_state& state, cl_kernel kernel, const std::string& name, cl_uint i) const
{
    if (owner_ && owner_->context.get() != state.context.get())
        state.fail("argument " + std::to_string(i) + " of " + name, "the buffer belongs to another queue's context");
    const cl_int code = is_memory_ ? clSetKernelArg(kernel, i, sizeof memory_, &memory_)
                                   : clSetKernelArg(kernel, i, size_, bytes_.data());
    if (code != CL_SUCCESS)
        state.fail("argument " + std::to_string(i) + " of " + name,
                   boost::compute::opencl_error::to_string(code) + " (the kernel expects another type than " +
                       std::string(type_) + ")",
                   code);
}

} // namespace taut::impl
