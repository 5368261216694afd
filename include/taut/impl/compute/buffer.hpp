// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/compute/queue.hpp>
#include <taut/impl/compute/scalar.hpp>

namespace taut
{

/// Array of n numbers in the memory of a device. Move-only; n = 0 is legal. Transfers are explicit and block the host;
/// nothing is written back by a destructor. Fresh memory is uninitialised.
template <class T>
class buffer
{
    static_assert(impl::device_scalar<T>,
                  "buffer<T>: T must be float, double or a 32 or 64 bit integer; split structs and "
                  "vectors into one buffer a component");

public:
    using value_type = T;

    /// Makes an empty buffer without a queue, to be assigned.
    buffer() = default;

    /// Allocates n elements. Throws device_error where they exceed the largest allocation or the free memory of the
    /// device: drivers that allocate lazily would crash later instead.
    buffer(queue& q, std::size_t n) : buffer(q, n, nullptr) {}

    /// Allocates and fills with values, which is cheaper than an upload: no command waits for others.
    buffer(queue& q, std::span<const T> values) : buffer(q, values.size(), values.data())
    {
        state_->counters.bytes_written += values.size_bytes();
    }
    buffer(queue& q, const std::vector<T>& values) : buffer(q, std::span<const T>(values)) {}

    buffer(buffer&& other) noexcept { swap(other); }
    buffer& operator=(buffer&& other) noexcept
    {
        buffer(std::move(other)).swap(*this);
        return *this;
    }
    buffer(const buffer&) = delete;
    buffer& operator=(const buffer&) = delete;
    ~buffer()
    {
        if (state_ && size_ != 0) state_->live_bytes -= bytes();
    }

    std::size_t size() const noexcept { return size_; }
    bool empty() const noexcept { return size_ == 0; }
    std::uint64_t bytes() const noexcept { return static_cast<std::uint64_t>(size_) * sizeof(T); }

    /// Copies values to elements offset, offset + 1, ... and waits.
    void upload(std::span<const T> values, std::size_t offset = 0)
    {
        check("upload to a buffer", offset, values.size());
        if (values.empty()) return;
        state_->run("uploading",
                    [&] {
                        state_->commands.enqueue_write_buffer(memory_, offset * sizeof(T), values.size_bytes(),
                                                              values.data());
                    });
        ++state_->counters.waits;
        state_->counters.bytes_written += values.size_bytes();
    }
    void upload(const std::vector<T>& values, std::size_t offset = 0) { upload(std::span<const T>(values), offset); }

    /// Waits for the commands before it, then copies elements offset, offset + 1, ... into values.
    void download(std::span<T> values, std::size_t offset = 0) const
    {
        check("download from a buffer", offset, values.size());
        if (values.empty()) return;
        state_->run(
            "downloading", [&]
            { state_->commands.enqueue_read_buffer(memory_, offset * sizeof(T), values.size_bytes(), values.data()); });
        ++state_->counters.waits;
        state_->counters.bytes_read += values.size_bytes();
    }

    /// Downloads elements 0, 1, ... without a wait: values are there, and must live, until the next command of this
    /// queue that waits: a download, an upload, finish().
    void begin_download(std::span<T> values) const
    {
        check("download from a buffer", 0, values.size());
        if (values.empty()) return;
        state_->run("downloading", [&]
                    { state_->commands.enqueue_read_buffer_async(memory_, 0, values.size_bytes(), values.data()); });
        state_->counters.bytes_read += values.size_bytes();
    }

    std::vector<T> download() const
    {
        std::vector<T> values(size_);
        download(std::span<T>(values));
        return values;
    }

    /// Sets every element; does not wait.
    void fill(T value)
    {
        if (size_ == 0) return;
        state_->run("filling", [&] { state_->commands.enqueue_fill_buffer(memory_, &value, sizeof(T), 0, bytes()); });
    }

    /// Copies all elements of other to elements offset, offset + 1, ...; does not wait.
    void copy_from(const buffer& other, std::size_t offset = 0)
    {
        check("copy to a buffer", offset, other.size_);
        if (other.empty() || this == &other) return;
        state_->run(
            "copying", [&]
            { state_->commands.enqueue_copy_buffer(other.memory_, memory_, 0, offset * sizeof(T), other.bytes()); });
    }

    /// Accessors for a command group: what the recorded kernel does with the buffer. Defined by the handler.
    template <class Handler>
    auto read(Handler& h) const
    {
        return h.reads(*this);
    }
    template <class Handler>
    auto write(Handler& h)
    {
        return h.writes(*this);
    }
    template <class Handler>
    auto read_write(Handler& h)
    {
        return h.updates(*this);
    }

    cl_mem native() const noexcept { return memory_.get(); }
    const std::shared_ptr<impl::queue_state>& state() const noexcept { return state_; }

    void swap(buffer& other) noexcept
    {
        std::swap(state_, other.state_);
        std::swap(memory_, other.memory_);
        std::swap(size_, other.size_);
    }

private:
    buffer(queue& q, std::size_t n, const T* values) : state_(q.state()), size_(n)
    {
        const std::string operation = "allocating " + std::to_string(n) + " x " + impl::cl_name<T>();
        impl::require_fp64<T>(*state_, operation);
        const auto& d = state_->device;
        if (n > std::numeric_limits<std::size_t>::max() / sizeof(T) || bytes() > d.max_allocation())
            state_->fail(operation, "the device allows " + std::to_string(d.max_allocation()) + " bytes in one buffer");
        if (bytes() + state_->live_bytes > d.global_memory())
            state_->fail(operation, "the device has " + std::to_string(d.global_memory()) + " bytes, of which " +
                                        std::to_string(state_->live_bytes) + " are in use by this queue");
        if (n == 0) return;
        constexpr cl_mem_flags copied = CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR;
        state_->run(operation,
                    [&]
                    {
                        memory_ = values
                                      ? boost::compute::buffer(state_->context, bytes(), copied, const_cast<T*>(values))
                                      : boost::compute::buffer(state_->context, bytes());
                    });
        state_->live_bytes += bytes();
    }

    void check(const char* what, std::size_t offset, std::size_t count) const
    {
        if (offset > size_ || count > size_ - offset)
            throw parameter_error(what, std::to_string(count) + " elements from " + std::to_string(offset) +
                                            " do not fit a buffer of " + std::to_string(size_));
    }

    std::shared_ptr<impl::queue_state> state_;
    boost::compute::buffer memory_;
    std::size_t size_ = 0;
};

// Compiled once, with the bodies.
extern template class buffer<float>;
extern template class buffer<double>;
extern template class buffer<idx>;

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/compute/buffer.ipp>
#endif
