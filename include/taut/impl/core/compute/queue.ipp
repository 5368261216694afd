// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include <taut/impl/core/compute/drivers.hpp>
#include <taut/impl/core/compute/event_state.hpp>
#include <taut/impl/core/compute/one_process.hpp>
#include <taut/impl/core/compute/queue_state.hpp>

namespace taut::impl
{

/// Returns whether the environment asks for kernels without optimisations.
inline bool wants_quick_builds()
{
    const char* wish = std::getenv("TAUT_BUILD");
    return wish && std::string_view(wish) == "quick";
}

inline std::shared_ptr<queue_state> open(const taut::device& device, opencl_opening how)
{
    how.quick = how.quick || wants_quick_builds();
    auto commands = device.is_host() ? open_host(device, how.profiling) : open_opencl(device, how);
    return std::make_shared<queue_state>(device, std::move(commands));
}

inline std::shared_ptr<queue_state> open(const taut::device& device, cl_context context, queue_options options)
{
    return open(device, {.context = context,
                         .profiling = options.profiling,
                         .quick = options.quick_builds,
                         .elsewhere = std::move(options.build_elsewhere)});
}

} // namespace taut::impl

namespace taut
{

event::event(std::shared_ptr<const state> s) : state_(std::move(s)) {}

void event::wait() const
{
    if (state_) state_->wait();
}

bool event::complete() const
{
    return !state_ || state_->complete();
}

std::optional<double> event::seconds() const
{
    return state_ ? state_->seconds() : std::nullopt;
}

cl_event event::native() const
{
    return state_ ? state_->native() : nullptr;
}

queue::queue(const taut::device& device, queue_options options)
    : state_(impl::open(device, nullptr, std::move(options)))
{
}

queue::queue(cl_context context, queue_options options)
    : state_(impl::open(impl::opencl_device_of(context), context, std::move(options)))
{
}

queue::queue(cl_command_queue native) : state_(impl::open(impl::opencl_device_of(native), {.commands = native})) {}

const taut::device& queue::device() const noexcept
{
    return state_->device;
}

void queue::finish()
{
    ++state_->counters.waits;
    state_->run("finishing the queue", [&] { state_->commands->finish(); });
}

queue_counters queue::counters() const
{
    queue_counters now = state_->counters;
    now.builds = state_->commands->builds();
    now.build_seconds = state_->commands->build_seconds();
    return now;
}

std::uint64_t queue::allocated() const noexcept
{
    return state_->live_bytes;
}

cl_command_queue queue::native() const
{
    const auto commands = state_->commands->native();
    if (!commands) state_->fail("asking for a command queue of OpenCL", "this device is none of OpenCL's");
    return commands;
}
cl_context queue::native_context() const
{
    const auto context = state_->commands->native_context();
    if (!context) state_->fail("asking for a context of OpenCL", "this device is none of OpenCL's");
    return context;
}

} // namespace taut
