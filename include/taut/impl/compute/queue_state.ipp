// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <taut/impl/compute/queue_state.hpp>

namespace taut::impl
{

queue_state::queue_state(taut::device d, boost::compute::context c, boost::compute::command_queue q, bool quick,
                         program_builder elsewhere)
    : device(std::move(d)),
      context(std::move(c)),
      commands(std::move(q)),
      cache(context, device, quick, std::move(elsewhere))
{
}

queue_state::~queue_state()
{
    if (!made_by_fork())
        clFinish(commands.get());
    else
        clRetainCommandQueue(commands.get());
}

void queue_state::ask_between_builds()
{
    if (!between_builds) return;
    clFinish(commands.get());
    between_builds();
}

void queue_state::await(const build_under_way& elsewhere)
{
    do ask_between_builds();
    while (elsewhere && elsewhere());
}

sole_use queue_state::enter() const
{
    if (made_by_fork()) refuse_fork("using a queue", device.label());
    return {user,
            [this] { fail("using a queue", "another thread is using it now; give each thread a queue of its own"); }};
}

event queue_state::launch(const boost::compute::kernel& kernel, const std::string& name, range r)
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

} // namespace taut::impl
