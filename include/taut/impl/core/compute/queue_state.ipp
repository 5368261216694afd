// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <taut/impl/core/compute/one_process.hpp>
#include <taut/impl/core/compute/queue_state.hpp>

namespace taut::impl
{

sole_use queue_state::enter() const
{
    if (!device.is_host() && made_by_fork()) refuse_fork("using a queue", device.label());
    return {user,
            [this] { fail("using a queue", "another thread is using it now; give each thread a queue of its own"); }};
}

event queue_state::launch(compiled_kernel& kernel, const std::string& name, std::span<const argument> arguments,
                          range r)
{
    for (const argument& a : arguments)
        if (a.owner() && a.owner() != this && a.owner()->commands->memory_space() != commands->memory_space())
            fail("argument " + std::to_string(&a - arguments.data()) + " of " + name,
                 "the buffer belongs to another queue's context");
    if (r.global == 0) return {};
    commands->ask_between_builds();
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
    event done = run("launching " + name, [&] { return commands->launch(kernel, arguments, r); });
    ++counters.launches;
    return done;
}

} // namespace taut::impl
