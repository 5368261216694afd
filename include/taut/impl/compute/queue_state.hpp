// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include <taut/impl/compute/event.hpp>
#include <taut/impl/compute/one_process.hpp>
#include <taut/impl/compute/program_cache.hpp>
#include <taut/impl/compute/queue_counters.hpp>
#include <taut/impl/compute/range.hpp>
#include <taut/impl/compute/sole_use.hpp>

namespace taut::impl
{

/// State that a queue shares with its buffers and kernels. It lives as long as any of them.
struct queue_state
{
    queue_state(taut::device d, boost::compute::context c, boost::compute::command_queue q, bool quick,
                program_builder elsewhere = {});

    /// Waits: PoCL compiles at launch, on threads of its own, and crashes if the process ends meanwhile. In a child
    /// that fork() has made there are none, so that it is left as it is.
    ~queue_state();

    queue_state(const queue_state&) = delete;
    queue_state& operator=(const queue_state&) = delete;

    taut::device device;
    boost::compute::context context;
    boost::compute::command_queue commands;
    program_cache cache;
    queue_counters counters;
    std::uint64_t live_bytes = 0; ///< sum of the sizes of the living buffers
    mutable sole_use::user user;

    /// While it is set, it is called before each kernel is looked up and each launch, once the device is idle: for
    /// warm-ups, in which drivers compile for seconds. What it throws passes through.
    std::function<void()> between_builds;

    void ask_between_builds();

    /// Waits for kernel builds of other processes.
    void await(const build_under_way& elsewhere);

    [[noreturn]] void fail(const std::string& operation, const std::string& reason, int code = 0) const
    {
        throw device_error(operation, reason, device.label(), code);
    }

    /// Keeps the queue to the calling thread. Throws device_error where another one is using it, and in a child made by
    /// fork().
    sole_use enter() const;

    /// Runs f; an OpenCL error becomes a device_error that names the operation.
    template <class F>
    decltype(auto) run(const std::string& operation, F&& f) const
    {
        const auto use = enter();
        try
        {
            return std::forward<F>(f)();
        }
        catch (const boost::compute::opencl_error& e)
        {
            fail(operation, e.error_string() + " (" + std::to_string(e.error_code()) + ")", e.error_code());
        }
    }

    /// Enqueues the kernel with the arguments it has. global = 0 launches nothing.
    event launch(const boost::compute::kernel& kernel, const std::string& name, range r);
};

} // namespace taut::impl

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/compute/queue_state.ipp>
#endif
