// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include <taut/impl/compute/real_buffer.hpp>

namespace taut::impl
{

/// Argument of a kernel in one launch: memory or a number, with the OpenCL C name of its type.
/// Numbers of type double are narrowed where the kernel is known to take float: precision is data.
class argument
{
public:
    template <class T>
    argument(const buffer<T>& b) : argument(b.native(), b.size(), cl_name<T>(), b.state().get())
    {
    }
    argument(const real_buffer& b)
        : argument(b.native(), b.size(), b.type() == scalar_type::f64 ? "double" : "float", b.state().get())
    {
    }
    template <device_scalar T>
    argument(T number) : type_(cl_name<T>()), size_(sizeof number)
    {
        std::memcpy(bytes_.data(), &number, sizeof number);
    }

    /// Memory of numbers that the caller vouches for.
    argument(cl_mem memory, std::size_t elements, std::string_view type, const queue_state* owner)
        : memory_(memory), is_memory_(true), elements_(elements), type_(type), owner_(owner)
    {
    }

    bool is_memory() const noexcept { return is_memory_; }
    cl_mem memory() const noexcept { return memory_; }
    std::size_t elements() const noexcept { return elements_; }
    std::string_view type() const noexcept { return type_; }

    /// The same number as the other type, if that is what double is to float; else itself.
    argument as(std::string_view type) const;

    void set(const queue_state& state, cl_kernel kernel, const std::string& name, cl_uint i) const;

private:
    cl_mem memory_ = nullptr;
    bool is_memory_ = false; // an empty buffer has no memory, but is no number
    std::size_t elements_ = std::numeric_limits<std::size_t>::max();
    std::string_view type_;
    const queue_state* owner_ = nullptr;
    std::size_t size_ = 0;
    std::array<std::byte, 8> bytes_{};
};

/// Real numbers on a device, whatever holds them; it refers to them.
class real_view : public impl::argument
{
public:
    real_view(const buffer<float>& b) : argument(b) {}
    real_view(const buffer<double>& b) : argument(b) {}
    real_view(const real_buffer& b) : argument(b) {}

    std::size_t size() const noexcept { return elements(); }
    scalar_type real() const noexcept { return type() == "double" ? scalar_type::f64 : scalar_type::f32; }
};

} // namespace taut::impl

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/compute/program/argument.ipp>
#endif
