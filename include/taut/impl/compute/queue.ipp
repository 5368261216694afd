// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <string_view>
#include <type_traits>
#include <utility>

#include <taut/impl/compute/queue.hpp>
#include <taut/impl/compute/queue_state.hpp>

namespace taut::impl
{

/// A handle of the user's, found to be alive. Throws device_error.
template <class Wrap>
std::invoke_result_t<Wrap> adopt(Wrap&& wrap)
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

/// Returns whether the environment asks for kernels without optimisations.
inline bool wants_quick_builds()
{
    const char* wish = std::getenv("TAUT_BUILD");
    return wish && std::string_view(wish) == "quick";
}

template <class MakeContext>
std::shared_ptr<queue_state> open(const taut::device& device, queue_options options, MakeContext&& make)
{
    refuse_fork("opening a queue");
    try
    {
        const boost::compute::context context = make();
        const cl_command_queue_properties flags = options.profiling ? CL_QUEUE_PROFILING_ENABLE : 0;
        boost::compute::command_queue commands(context, boost::compute::device(device.native()), flags);
        return std::make_shared<queue_state>(device, context, std::move(commands),
                                             options.quick_builds || wants_quick_builds(),
                                             std::move(options.build_elsewhere));
    }
    catch (const boost::compute::opencl_error& e)
    {
        throw device_error("opening a queue", e.error_string(), device.label(), e.error_code());
    }
}

} // namespace taut::impl

namespace taut
{

queue::queue(const taut::device& device, queue_options options)
    : state_(impl::open(device, std::move(options),
                        [&] { return boost::compute::context(boost::compute::device(device.native())); }))
{
}

queue::queue(cl_context context, queue_options options)
{
    auto adopted = impl::adopt([&] { return boost::compute::context(context); });
    state_ = impl::open(taut::device(adopted.get_device().id()), std::move(options), [&] { return adopted; });
}

queue::queue(cl_command_queue native)
{
    const auto adopted = impl::adopt([&] { return boost::compute::command_queue(native); });
    state_ = std::make_shared<impl::queue_state>(taut::device(adopted.get_device().id()), adopted.get_context(),
                                                 adopted, impl::wants_quick_builds());
    const auto properties = adopted.get_info<cl_command_queue_properties>(CL_QUEUE_PROPERTIES);
    if (properties & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE)
        state_->fail("adopting a command queue", "it is out of order; taut relies on the order of commands");
}

const taut::device& queue::device() const noexcept
{
    return state_->device;
}

void queue::finish()
{
    ++state_->counters.waits;
    state_->run("finishing the queue", [&] { state_->commands.finish(); });
}

impl::queue_counters queue::counters() const
{
    impl::queue_counters now = state_->counters;
    now.builds = state_->cache.builds();
    now.build_seconds = state_->cache.seconds();
    return now;
}

std::uint64_t queue::allocated() const noexcept
{
    return state_->live_bytes;
}

cl_command_queue queue::native() const
{
    return state_->commands.get();
}
cl_context queue::native_context() const
{
    return state_->context.get();
}

} // namespace taut
