// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <string>
#include <utility>

#include <taut/impl/core/compute/device_memory.hpp>
#include <taut/impl/core/compute/queue_state.hpp>
#include <taut/queue.hpp>

namespace taut::impl
{

device_memory::device_memory(const queue& q, number_type type, std::size_t n, const void* values)
    : state_(state_of(q)), size_(n), type_(type)
{
    const std::string operation = "allocating " + std::to_string(n) + " x " + type.name;
    if (is_double()) require_fp64(*state_, scalar_type::f64, operation);
    const auto& d = state_->device;
    if (n > std::numeric_limits<std::size_t>::max() / type.bytes || bytes() > d.max_allocation())
        state_->fail(operation, "the device allows " + std::to_string(d.max_allocation()) + " bytes in one buffer");
    if (bytes() + state_->live_bytes > d.global_memory())
        state_->fail(operation, "the device has " + std::to_string(d.global_memory()) + " bytes, of which " +
                                    std::to_string(state_->live_bytes) + " are in use by this queue");
    if (n == 0) return;
    state_->run(operation, [&] { handle_ = state_->commands->allocate(bytes(), values); });
    state_->live_bytes += bytes();
    if (values) state_->counters.bytes_written += bytes();
}

device_memory::device_memory(device_memory&& other) noexcept
    : state_(std::move(other.state_)),
      handle_(std::exchange(other.handle_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      type_(other.type_)
{
}

device_memory& device_memory::operator=(device_memory&& other) noexcept
{
    device_memory moved(std::move(other));
    std::swap(state_, moved.state_);
    std::swap(handle_, moved.handle_);
    std::swap(size_, moved.size_);
    std::swap(type_, moved.type_);
    return *this;
}

device_memory::~device_memory()
{
    if (!handle_) return;
    state_->live_bytes -= bytes();
    state_->commands->release(handle_);
}

void device_memory::write(const void* values, std::size_t n, std::size_t offset)
{
    check("upload to a buffer", offset, n);
    if (n == 0) return;
    state_->run("uploading", [&] { state_->commands->write(handle_, offset * type_.bytes, n * type_.bytes, values); });
    ++state_->counters.waits;
    state_->counters.bytes_written += n * type_.bytes;
}

void device_memory::read(void* values, std::size_t n, std::size_t offset) const
{
    check("download from a buffer", offset, n);
    if (n == 0) return;
    state_->run("downloading",
                [&] { state_->commands->read(handle_, offset * type_.bytes, n * type_.bytes, values, true); });
    ++state_->counters.waits;
    state_->counters.bytes_read += n * type_.bytes;
}

void device_memory::begin_read(void* values, std::size_t n) const
{
    check("download from a buffer", 0, n);
    if (n == 0) return;
    state_->run("downloading", [&] { state_->commands->read(handle_, 0, n * type_.bytes, values, false); });
    state_->counters.bytes_read += n * type_.bytes;
}

void device_memory::fill(const void* value)
{
    if (size_ == 0) return;
    state_->run("filling", [&] { state_->commands->fill(handle_, bytes(), value, type_.bytes); });
}

void device_memory::copy_from(const device_memory& other, std::size_t offset)
{
    check("copy to a buffer", offset, other.size_);
    if (other.size_ == 0 || this == &other) return;
    state_->run("copying",
                [&] { state_->commands->copy(other.handle_, handle_, offset * type_.bytes, other.bytes()); });
}

cl_mem device_memory::native() const
{
    if (state_ && state_->device.is_host())
        state_->fail("asking for a buffer of OpenCL", "this device is none of OpenCL's");
    return static_cast<cl_mem>(handle_);
}

void device_memory::check(const char* what, std::size_t offset, std::size_t count) const
{
    if (offset > size_ || count > size_ - offset)
        throw parameter_error(what, std::to_string(count) + " elements from " + std::to_string(offset) +
                                        " do not fit a buffer of " + std::to_string(size_));
}

} // namespace taut::impl
