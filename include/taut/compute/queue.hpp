// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <ostream>
#include <string>
#include <type_traits>
#include <utility>

#include <taut/compute/choose_device.hpp>
#include <taut/compute/detail/queue_state.hpp>

namespace taut
{

class handler;
template <class... Args>
class typed_kernel;

struct queue_options
{
    bool profiling = false; ///< event::seconds() works; costs a little at each launch
};

/// An in-order queue of commands to one device, with its context and its cache of built programs. Copies share all of
/// it, and buffers and kernels keep it alive. Commands run in the order in which they are given; only downloads,
/// uploads, finish() and event::wait() block the host. One thread at a time: the arguments of a kernel object are not
/// thread-safe.
class queue
{
public:
    /// On the best device, or the one that TAUT_DEVICE names. Throws no_device.
    queue() : queue(choose_device()) {}

    explicit queue(const taut::device& device, queue_options options = {})
        : state_(
              open(device, options, [&] { return boost::compute::context(boost::compute::device(device.native())); }))
    {
    }

    /// In the user's context, on its first device. The context is retained.
    explicit queue(cl_context context, queue_options options = {})
        : queue(adopt([&] { return boost::compute::context(context); }), options)
    {
    }

    /// Through the user's command queue, which is retained and must be in-order.
    explicit queue(cl_command_queue native) : queue(adopt([&] { return boost::compute::command_queue(native); })) {}

    const taut::device& device() const noexcept { return state_->device; }

    /// Blocks until every command given so far has run.
    void finish()
    {
        ++state_->counters.waits;
        state_->run("finishing the queue", [&] { state_->commands.finish(); });
    }

    /// Records and enqueues one command group: f takes a handler&. Declared here, defined in handler.hpp.
    template <class F>
    event submit(F&& f);

    /// The kernel called name in OpenCL C source, with the C++ types of its arguments in order: buffer<T>,
    /// const buffer<T>, or a scalar. Built at the first request, then found in the cache. Defined in kernel.hpp.
    template <class... Args>
    typed_kernel<Args...> kernel(const std::string& source, const std::string& name, const std::string& options = {});

    queue_counters counters() const
    {
        queue_counters now = state_->counters;
        now.builds = state_->cache.builds();
        now.build_seconds = state_->cache.seconds();
        return now;
    }

    /// Bytes in the living buffers of this queue.
    std::uint64_t allocated() const noexcept { return state_->live_bytes; }

    cl_command_queue native() const { return state_->commands.get(); }
    cl_context native_context() const { return state_->context.get(); }

    /// For the other headers of this folder.
    const std::shared_ptr<detail::queue_state>& state() const noexcept { return state_; }

    friend bool operator==(const queue& a, const queue& b) { return a.state_ == b.state_; }
    friend std::ostream& operator<<(std::ostream& out, const queue& q) { return out << "queue on " << q.device(); }

private:
    queue(const boost::compute::context& context, queue_options options)
        : state_(open(taut::device(context.get_device().id()), options, [&] { return context; }))
    {
    }

    explicit queue(const boost::compute::command_queue& native)
        : state_(std::make_shared<detail::queue_state>(taut::device(native.get_device().id()), native.get_context(),
                                                       native))
    {
        const auto properties = native.get_info<cl_command_queue_properties>(CL_QUEUE_PROPERTIES);
        if (properties & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE)
            state_->fail("adopting a command queue", "it is out of order; taut relies on the order of commands");
    }

    /// A handle of the user's, found to be alive. Throws device_error.
    template <class Wrap>
    static std::invoke_result_t<Wrap> adopt(Wrap&& wrap)
    {
        try
        {
            auto handle = wrap();
            handle.get_device();
            return handle;
        }
        catch (const boost::compute::opencl_error& e)
        {
            throw device_error("adopting the user's context or queue", e.error_string(), "", e.error_code());
        }
    }

    template <class MakeContext>
    static std::shared_ptr<detail::queue_state> open(const taut::device& device, queue_options options,
                                                     MakeContext&& make)
    {
        try
        {
            const boost::compute::context context = make();
            const cl_command_queue_properties flags = options.profiling ? CL_QUEUE_PROFILING_ENABLE : 0;
            boost::compute::command_queue commands(context, boost::compute::device(device.native()), flags);
            return std::make_shared<detail::queue_state>(device, context, std::move(commands));
        }
        catch (const boost::compute::opencl_error& e)
        {
            throw device_error("opening a queue", e.error_string(), device.label(), e.error_code());
        }
    }

    std::shared_ptr<detail::queue_state> state_;
};

} // namespace taut
