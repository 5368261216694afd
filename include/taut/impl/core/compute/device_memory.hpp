// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include <taut/impl/core/compute/cl.hpp>
#include <taut/impl/core/compute/scalar.hpp>

namespace taut
{

class queue;

} // namespace taut

namespace taut::impl
{

struct queue_state;

/// Memory as a device names it: a cl_mem, or a pointer of the host.
using memory_handle = void*;

/// n numbers of one type in the memory of a device, which buffer<T> and real_buffer are made of. Functions that take
/// values take that many of the type.
class device_memory
{
public:
    device_memory() = default;

    /// values: n of them, or null. Throws device_error.
    device_memory(const queue& q, number_type type, std::size_t n, const void* values);
    device_memory(device_memory&& other) noexcept;
    device_memory& operator=(device_memory&& other) noexcept;
    ~device_memory();

    std::size_t size() const noexcept { return size_; }
    std::uint64_t bytes() const noexcept { return static_cast<std::uint64_t>(size_) * type_.bytes; }
    const char* type() const noexcept { return type_.name; }
    bool is_double() const noexcept { return std::string_view(type_.name) == "double"; }

    /// Throw parameter_error for elements beyond the end, device_error.
    void write(const void* values, std::size_t n, std::size_t offset);
    void read(void* values, std::size_t n, std::size_t offset) const;
    void begin_read(void* values, std::size_t n) const;
    void fill(const void* value);
    void copy_from(const device_memory& other, std::size_t offset);

    memory_handle handle() const noexcept { return handle_; }
    const queue_state* owner() const noexcept { return state_.get(); }
    /// Throws device_error on the host device.
    cl_mem native() const;

private:
    void check(const char* what, std::size_t offset, std::size_t count) const;

    std::shared_ptr<queue_state> state_;
    memory_handle handle_ = nullptr;
    std::size_t size_ = 0;
    number_type type_{"float", sizeof(float)};
};

} // namespace taut::impl
