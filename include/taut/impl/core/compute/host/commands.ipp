// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cstring>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include <taut/device.hpp>
#include <taut/impl/core/compute/drivers.hpp>
#include <taut/impl/core/compute/event_state.hpp>
#include <taut/impl/core/compute/host/commands.hpp>
#include <taut/impl/core/compute/host/row_launch.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/kernel.hpp>

namespace taut::impl
{

/// Memory begins where vectors of any width may, and where lines of a cache do.
inline constexpr std::align_val_t host_alignment{128};

/// A recorded kernel on the host.
struct host_recording : compiled_kernel
{
    std::shared_ptr<const row_program> rows;
    std::size_t count = 0;

    std::size_t arguments() const override { return count; }
};

/// One of kernels/*.cl on the host.
struct host_own : compiled_kernel
{
    host_kernel kernel;
    std::vector<kernel_text> parts;

    std::size_t arguments() const override { return kernel.arguments; }
};

/// A command that has run.
class host_state : public event::state
{
public:
    explicit host_state(double seconds) : seconds_(seconds) {}
    std::optional<double> seconds() const override { return seconds_; }

private:
    double seconds_;
};

memory_handle host_commands::allocate(std::size_t bytes, const void* values)
{
    void* const memory = ::operator new(bytes, host_alignment, std::nothrow);
    if (!memory) throw command_failure{"there is no memory left"};
    if (values) std::memcpy(memory, values, bytes);
    return memory;
}

void host_commands::release(memory_handle memory) noexcept
{
    ::operator delete(memory, host_alignment);
}

void host_commands::write(memory_handle to, std::size_t offset, std::size_t bytes, const void* values)
{
    std::memcpy(static_cast<char*>(to) + offset, values, bytes);
}

void host_commands::read(memory_handle from, std::size_t offset, std::size_t bytes, void* values, bool)
{
    std::memcpy(values, static_cast<const char*>(from) + offset, bytes);
}

void host_commands::fill(memory_handle memory, std::size_t bytes, const void* value, std::size_t value_bytes)
{
    char* const to = static_cast<char*>(memory);
    std::memcpy(to, value, std::min(bytes, value_bytes));
    for (std::size_t done = value_bytes; done < bytes; done *= 2)
        std::memcpy(to + done, to, std::min(done, bytes - done));
}

void host_commands::copy(memory_handle from, memory_handle to, std::size_t offset, std::size_t bytes)
{
    std::memmove(static_cast<char*>(to) + offset, from, bytes);
}

std::shared_ptr<compiled_kernel> host_commands::of_text(const std::string&, const std::string& name, const std::string&)
{
    throw build_error(name,
                      "the host device compiles no OpenCL C: record the kernel (parallel_for, trace), or choose an "
                      "OpenCL device\n",
                      "", label_, 0);
}

std::shared_ptr<compiled_kernel> host_commands::of_own(const own_program& program, const std::string& name)
{
    for (const host_program& form : program.host())
    {
        bool same = true;
        for (const setting& s : form.settings)
            same = same && std::find(program.settings.begin(), program.settings.end(), s) != program.settings.end();
        if (!same) continue;
        for (const host_kernel& kernel : form.kernels)
            if (kernel.name == name)
            {
                const auto made = std::make_shared<host_own>();
                made->kernel = kernel;
                made->parts = program.parts;
                return made;
            }
    }
    throw device_error("creating kernel " + name, "the host has no such kernel for " + program.options(), label_);
}

std::shared_ptr<compiled_kernel> host_commands::of_recording(const kernel_text& recorded, const std::string&)
{
    if (!recorded.rows)
        throw device_error("creating kernel " + recorded.name, "it was not recorded for the host device", label_);
    const auto made = std::make_shared<host_recording>();
    made->rows = recorded.rows;
    made->count = recorded.arguments.size();
    return made;
}

inline void run(const host_recording& kernel, std::span<const argument> arguments)
{
    constexpr std::size_t block = 128;
    std::vector<host_argument> all;
    idx count = 0;
    std::memcpy(&count, arguments.back().value(), sizeof count);
    for (const argument& a : arguments.first(arguments.size() - 1))
    {
        host_argument& made = all.emplace_back(static_cast<const void*>(a.memory()));
        if (!a.is_memory()) std::memcpy(&made.bits, a.value(), a.value_bytes());
    }
    const row_launch launch(*kernel.rows, all);
    parallel_for((static_cast<std::size_t>(count) + block - 1) / block,
                 [&](std::size_t begin, std::size_t end)
                 {
                     launch.run(static_cast<idx>(begin * block),
                                static_cast<idx>(std::min(end * block, static_cast<std::size_t>(count))));
                 },
                 0, 8);
}

inline void run(const host_own& own, std::span<const argument> arguments, std::size_t items)
{
    std::vector<const void*> values;
    for (std::size_t i = 0; i < arguments.size(); ++i)
    {
        const argument& a = arguments[i];
        if (a.is_memory() != ((own.kernel.memory >> i & 1) != 0))
            throw command_failure{"argument " + std::to_string(i) + " is " + (a.is_memory() ? "memory" : "a number")};
        values.push_back(a.value());
    }
    const host_call call{values.data(), items, own.parts};
    parallel_for(
        items, [&](std::size_t begin, std::size_t end) { own.kernel.run(call, begin, end); }, 0, own.kernel.grain);
}

event host_commands::launch(compiled_kernel& kernel, std::span<const argument> arguments, const range& r)
{
    const auto start = std::chrono::steady_clock::now();
    if (const auto* const own = dynamic_cast<const host_own*>(&kernel))
        run(*own, arguments, r.global);
    else
        run(static_cast<const host_recording&>(kernel), arguments);
    if (!profiling_) return {};
    return event(
        std::make_shared<host_state>(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()));
}

const void* host_commands::memory_space() const noexcept
{
    static const char everywhere = 0;
    return &everywhere;
}

std::unique_ptr<device_commands> open_host(const device& d, bool profiling)
{
    return std::make_unique<host_commands>(d.label(), profiling);
}

} // namespace taut::impl
