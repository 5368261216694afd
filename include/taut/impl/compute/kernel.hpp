// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <taut/impl/compute/program/argument.hpp>
#include <taut/impl/compute/program/signature.hpp>

namespace taut::impl
{

/// Named argument of a launch.
struct named_argument
{
    const char* name;
    impl::argument value;
};

} // namespace taut::impl

namespace taut
{

/// Kernel of OpenCL C source. A launch sets the arguments and enqueues it; nothing waits. Arguments are bound by name,
/// in any order, or by position:
///
///     kernel scale(q, source, "scale");
///     scale(n, {{"x", x}, {"factor", 2.0}});
///     scale(n, x, 2.0f);
///
/// By name, types are checked, and a number of type double narrows to what the kernel takes.
class kernel
{
public:
    kernel() = default;

    /// real: value of the source's macro REAL. Throws build_error, or device_error where the kernel takes double and
    /// the device has none.
    kernel(queue& q, const std::string& source, const std::string& name, const std::string& options = {},
           scalar_type real = scalar_type::f32);

    /// Makes a kernel with the names and types of its arguments.
    kernel(queue& q, const std::string& source, std::string name, const std::string& options,
           std::vector<impl::parameter> signature);

    /// Throws parameter_error for an argument that is missing, unknown, there twice, or of another type.
    event operator()(range r, std::initializer_list<impl::named_argument> arguments) const
    {
        return launch(r, std::span(arguments.begin(), arguments.size()));
    }
    event launch(range r, std::span<const impl::named_argument> arguments) const;

    /// By position; OpenCL checks sizes only. Throws parameter_error for another number of arguments.
    event operator()(range r, std::span<const impl::argument> arguments) const;
    template <class... Args>
        requires(sizeof...(Args) > 0 && (std::is_constructible_v<impl::argument, const Args&> && ...))
    event operator()(range r, const Args&... args) const
    {
        const impl::argument arguments[] = {args...};
        return (*this)(r, std::span<const impl::argument>(arguments));
    }

    const std::string& name() const noexcept { return name_; }
    explicit operator bool() const noexcept { return state_ != nullptr; }

    /// Throws device_error if it takes another number of arguments.
    void require_arguments(std::size_t n) const;

private:
    event enqueue(range r) const;

    [[noreturn]] void refuse(const std::string& why) const { throw parameter_error("kernel " + name_, why); }

    static std::string describe(std::string_view type, bool is_memory)
    {
        return (is_memory ? "a buffer of " : "a number of type ") + std::string(type);
    }

    /// Position of the parameter; guess: its position if the arguments come in order.
    std::size_t position(const char* name, std::size_t guess) const;

    std::shared_ptr<impl::queue_state> state_;
    boost::compute::kernel kernel_;
    std::string name_;
    std::vector<impl::parameter> signature_;
    std::size_t count_ = 0;                   ///< of its arguments
    mutable impl::build_under_way under_way_; ///< elsewhere, to be waited for at the first launch
};

} // namespace taut

namespace taut::impl
{

/// A kernel that is built when it is first launched: until then its program may be built elsewhere.
class late_kernel
{
public:
    late_kernel() = default;
    explicit late_kernel(std::function<kernel()> build) : build_(std::move(build)) {}

    event operator()(range r, std::initializer_list<named_argument> arguments) const;

private:
    std::function<kernel()> build_;
    mutable kernel built_;
};

template <class T>
struct argument_traits
{
    static_assert(device_scalar<T>, "typed_kernel: an argument is buffer<T>, const buffer<T> or a device scalar");
    using element = T;
    using passed = T; // by value
};

template <class T>
struct argument_traits<buffer<T>>
{
    using element = T;
    using passed = buffer<T>&;
};

template <class T>
struct argument_traits<const buffer<T>>
{
    using element = T;
    using passed = const buffer<T>&;
};

/// A kernel with the C++ types of its arguments, in the order of its OpenCL C signature: buffer<T> for __global T*,
/// const buffer<T> for __global const T*, and scalars.
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
    {
        (impl::require_fp64<typename impl::argument_traits<Args>::element>(*q.state(), "kernel " + name), ...);
        kernel_ = kernel(q, source, std::move(name), options, std::vector<impl::parameter>{});
        kernel_.require_arguments(sizeof...(Args));
    }

    event operator()(range r, typename impl::argument_traits<Args>::passed... args) const
    {
        return kernel_(r, args...);
    }

    const std::string& name() const noexcept { return kernel_.name(); }
    explicit operator bool() const noexcept { return bool(kernel_); }

private:
    kernel kernel_;
};

} // namespace taut::impl

namespace taut
{

template <class... Args>
impl::typed_kernel<Args...> queue::kernel(const std::string& source, const std::string& name,
                                          const std::string& options)
{
    return impl::typed_kernel<Args...>(*this, source, name, options);
}

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/compute/kernel.ipp>
#endif
