// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
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
                program_builder elsewhere = {})
        : device(std::move(d)),
          context(std::move(c)),
          commands(std::move(q)),
          cache(context, device, quick, std::move(elsewhere))
    {
    }

    /// Waits: PoCL compiles at launch, on threads of its own, and crashes if the process ends meanwhile. In a child
    /// that fork() has made there are none, so that it is left as it is.
    ~queue_state()
    {
        if (!made_by_fork())
            clFinish(commands.get());
        else
            clRetainCommandQueue(commands.get());
    }

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

    void ask_between_builds()
    {
        if (!between_builds) return;
        clFinish(commands.get());
        between_builds();
    }

    /// Waits for kernel builds of other processes.
    void await(const build_under_way& elsewhere)
    {
        do ask_between_builds();
        while (elsewhere && elsewhere());
    }

    [[noreturn]] void fail(const std::string& operation, const std::string& reason, int code = 0) const
    {
        throw device_error(operation, reason, device.label(), code);
    }

    /// Keeps the queue to the calling thread. Throws device_error where another one is using it, and in a child made by
    /// fork().
    sole_use enter() const
    {
        if (made_by_fork()) refuse_fork("using a queue", device.label());
        return {user, [this]
                { fail("using a queue", "another thread is using it now; give each thread a queue of its own"); }};
    }

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
    event launch(const boost::compute::kernel& kernel, const std::string& name, range r)
    {
        if (r.global == 0) return {};
        ask_between_builds();
        if (r.local == 0)
        {
            const std::size_t usual = device.is_gpu() ? 128 : 64;
            if (r.global % usual == 0 && usual <= device.max_group()) r.local = usual;
        }
        else if (r.global % r.local != 0 || r.local > device.max_group())
        {
            fail("launching " + name, "local size " + std::to_string(r.local) + " must divide the global size " +
                                          std::to_string(r.global) + " and be at most " +
                                          std::to_string(device.max_group()));
        }
        cl_event raw = nullptr;
        const cl_int code = clEnqueueNDRangeKernel(commands.get(), kernel.get(), 1, nullptr, &r.global,
                                                   r.local ? &r.local : nullptr, 0, nullptr, &raw);
        if (code != CL_SUCCESS)
            fail("launching " + name, boost::compute::opencl_error::to_string(code) + " (" + std::to_string(code) + ")",
                 code);
        ++counters.launches;
        return event(boost::compute::event(raw, false));
    }
};

} // namespace taut::impl
