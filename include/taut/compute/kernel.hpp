// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <utility>

#include <taut/compute/buffer.hpp>

namespace taut
{

namespace detail
{

template <class T>
struct argument_traits
{
    static_assert(device_scalar<T>, "typed_kernel: an argument is buffer<T>, const buffer<T> or a device scalar");
    using element = T;
    using passed = T; // by value
    static constexpr bool is_buffer = false;
};

template <class T>
struct argument_traits<buffer<T>>
{
    using element = T;
    using passed = buffer<T>&;
    static constexpr bool is_buffer = true;
};

template <class T>
struct argument_traits<const buffer<T>>
{
    using element = T;
    using passed = const buffer<T>&;
    static constexpr bool is_buffer = true;
};

template <class T>
void set_argument(const queue_state& state, cl_kernel kernel, const std::string& name, cl_uint i, const buffer<T>& b)
{
    if (b.state() && b.state()->context.get() != state.context.get())
        state.fail("argument " + std::to_string(i) + " of " + name, "the buffer belongs to another queue's context");
    const cl_mem memory = b.native();
    const cl_int code = clSetKernelArg(kernel, i, sizeof memory, &memory);
    if (code != CL_SUCCESS)
        state.fail("argument " + std::to_string(i) + " of " + name, boost::compute::opencl_error::to_string(code),
                   code);
}

template <device_scalar T>
void set_argument(const queue_state& state, cl_kernel kernel, const std::string& name, cl_uint i, const T& value)
{
    const cl_int code = clSetKernelArg(kernel, i, sizeof value, &value);
    if (code != CL_SUCCESS)
        state.fail("argument " + std::to_string(i) + " of " + name,
                   boost::compute::opencl_error::to_string(code) + " (the kernel expects another type than " +
                       cl_name<T>() + ")",
                   code);
}

} // namespace detail

/// A kernel with the C++ types of its arguments, in the order of its OpenCL C signature: buffer<T> for __global T*,
/// const buffer<T> for __global const T*, and scalars. Calling it sets the arguments and enqueues it; nothing waits.
///
///     auto scale = q.kernel<buffer<float>, float>(source, "scale");
///     scale(n, x, 2.0f);
template <class... Args>
class typed_kernel
{
public:
    typed_kernel() = default;

    /// Throws build_error, or device_error if the kernel takes another number of arguments or double where the device
    /// has none.
    typed_kernel(queue& q, const std::string& source, std::string name, const std::string& options = {})
        : state_(q.state()), name_(std::move(name))
    {
        const auto use = state_->enter();
        (detail::require_fp64<typename detail::argument_traits<Args>::element>(*state_, "kernel " + name_), ...);
        state_->ask_between_builds();
        kernel_ = state_->cache.find(source, name_, options);
        const auto expected = kernel_.get_info<cl_uint>(CL_KERNEL_NUM_ARGS);
        if (expected != sizeof...(Args))
            state_->fail("kernel " + name_,
                         "it takes " + std::to_string(expected) + " arguments, not " + std::to_string(sizeof...(Args)));
    }

    event operator()(range r, typename detail::argument_traits<Args>::passed... args) const
    {
        const auto use = state_->enter();
        cl_uint i = 0;
        (detail::set_argument(*state_, kernel_.get(), name_, i++, args), ...);
        return state_->launch(kernel_, name_, r);
    }

    const std::string& name() const noexcept { return name_; }
    explicit operator bool() const noexcept { return state_ != nullptr; }

private:
    std::shared_ptr<detail::queue_state> state_;
    boost::compute::kernel kernel_;
    std::string name_;
};

template <class... Args>
typed_kernel<Args...> queue::kernel(const std::string& source, const std::string& name, const std::string& options)
{
    return typed_kernel<Args...>(*this, source, name, options);
}

} // namespace taut
