// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include <taut/impl/core/compute/commands.hpp>
#include <taut/impl/core/compute/sole_use.hpp>
#include <taut/options.hpp>
#include <taut/queue.hpp>

namespace taut::impl
{

/// State that a queue shares with its buffers and kernels. It lives as long as any of them.
struct queue_state
{
    queue_state(taut::device d, std::unique_ptr<device_commands> c) : device(std::move(d)), commands(std::move(c)) {}
    queue_state(const queue_state&) = delete;
    queue_state& operator=(const queue_state&) = delete;

    taut::device device;
    std::unique_ptr<device_commands> commands;
    queue_counters counters;
    std::uint64_t live_bytes = 0; ///< sum of the sizes of the living buffers
    mutable sole_use::user user;

    [[noreturn]] void fail(const std::string& operation, const std::string& reason, int code = 0) const
    {
        throw device_error(operation, reason, device.label(), code);
    }

    /// Keeps the queue to the calling thread. Throws device_error where another one is using it, and in a child made by
    /// fork() on a device whose driver does not survive that.
    sole_use enter() const;

    /// Runs f; what a device refuses becomes a device_error that names the operation.
    template <class F>
    decltype(auto) run(const std::string& operation, F&& f) const
    {
        const auto use = enter();
        try
        {
            return std::forward<F>(f)();
        }
        catch (const command_failure& e)
        {
            fail(operation, e.code ? e.reason + " (" + std::to_string(e.code) + ")" : e.reason, e.code);
        }
    }

    /// Enqueues the kernel. global = 0 launches nothing.
    event launch(compiled_kernel& kernel, const std::string& name, std::span<const argument> arguments, range r);
};

inline const std::shared_ptr<queue_state>& state_of(const queue& q) noexcept
{
    return q.state_;
}

/// Refuses double early on a device without it; the driver would only fail later and less clearly.
inline void require_fp64(const queue_state& state, scalar_type type, const std::string& operation)
{
    if (type == scalar_type::f64 && !state.device.has_fp64())
        state.fail(operation, "the device has no double precision (fp64); use float, or another device");
}

} // namespace taut::impl
