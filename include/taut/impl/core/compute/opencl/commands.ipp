// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <utility>

#include <taut/impl/core/compute/event_state.hpp>
#include <taut/impl/core/compute/one_process.hpp>
#include <taut/impl/core/compute/opencl/commands.hpp>
#include <taut/impl/core/compute/program/joined_source.hpp>
#include <taut/kernel.hpp>

namespace taut::impl
{

/// Runs f; an error of OpenCL becomes a command_failure.
template <class F>
decltype(auto) told(F&& f)
{
    try
    {
        return std::forward<F>(f)();
    }
    catch (const boost::compute::opencl_error& e)
    {
        throw command_failure{e.error_string(), e.error_code()};
    }
}

/// A kernel of OpenCL, with the arguments of its last launch.
struct opencl_compiled : compiled_kernel
{
    boost::compute::kernel kernel; ///< of the program cache
    std::string name;
    std::size_t count = 0;
    queue_options::wait_for_build under_way = nullptr; ///< elsewhere, to be waited for at the first launch

    std::size_t arguments() const override { return count; }
};

/// A command of OpenCL.
class opencl_state : public event::state
{
public:
    explicit opencl_state(boost::compute::event e) : event_(std::move(e)) {}

    void wait() const override
    try
    {
        event_.wait();
    }
    catch (const boost::compute::opencl_error& e)
    {
        throw device_error("waiting for a command", e.error_string(), "", e.error_code());
    }
    bool complete() const override
    try
    {
        return event_.status() == CL_COMPLETE;
    }
    catch (const boost::compute::opencl_error& e)
    {
        throw device_error("asking for the state of a command", e.error_string(), "", e.error_code());
    }
    std::optional<double> seconds() const override
    try
    {
        return 1e-9 * static_cast<double>(event_.get_profiling_info<cl_ulong>(CL_PROFILING_COMMAND_END) -
                                          event_.get_profiling_info<cl_ulong>(CL_PROFILING_COMMAND_START));
    }
    catch (const boost::compute::opencl_error&)
    {
        return std::nullopt;
    }
    cl_event native() const override { return event_.get(); }

private:
    boost::compute::event event_;
};

inline boost::compute::buffer as_buffer(memory_handle memory)
{
    return boost::compute::buffer(static_cast<cl_mem>(memory));
}

opencl_commands::opencl_commands(const taut::device& d, boost::compute::context context,
                                 boost::compute::command_queue commands, bool quick, queue_options::builder elsewhere)
    : context_(std::move(context)), commands_(std::move(commands)), cache_(context_, d, quick, std::move(elsewhere))
{
}

opencl_commands::~opencl_commands()
{
    if (!made_by_fork())
        settle();
    else
        opencl_library::get().clRetainCommandQueue(commands_.get());
}

memory_handle opencl_commands::allocate(std::size_t bytes, const void* values)
{
    const cl_mem_flags flags = values ? CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR : CL_MEM_READ_WRITE;
    auto made = told([&] { return boost::compute::buffer(context_, bytes, flags, const_cast<void*>(values)); });
    return std::exchange(made.get(), nullptr);
}

void opencl_commands::release(memory_handle memory) noexcept
{
    const boost::compute::buffer last(static_cast<cl_mem>(memory), false);
}

void opencl_commands::write(memory_handle to, std::size_t offset, std::size_t bytes, const void* values)
{
    told([&] { commands_.enqueue_write_buffer(as_buffer(to), offset, bytes, values); });
}

void opencl_commands::read(memory_handle from, std::size_t offset, std::size_t bytes, void* values, bool wait)
{
    told(
        [&]
        {
            if (wait)
                commands_.enqueue_read_buffer(as_buffer(from), offset, bytes, values);
            else
                commands_.enqueue_read_buffer_async(as_buffer(from), offset, bytes, values);
        });
}

void opencl_commands::fill(memory_handle memory, std::size_t bytes, const void* value, std::size_t value_bytes)
{
    told([&] { commands_.enqueue_fill_buffer(as_buffer(memory), value, value_bytes, 0, bytes); });
}

void opencl_commands::copy(memory_handle from, memory_handle to, std::size_t offset, std::size_t bytes)
{
    told([&] { commands_.enqueue_copy_buffer(as_buffer(from), as_buffer(to), 0, offset, bytes); });
}

std::shared_ptr<compiled_kernel> opencl_commands::of_text(const std::string& text, const std::string& name,
                                                          const std::string& options)
{
    await(cache_.under_way(text, options));
    const auto made = std::make_shared<opencl_compiled>();
    made->kernel = cache_.find(text, name, options);
    made->name = name;
    made->under_way = cache_.under_way(text, options, name);
    made->count = told([&] { return made->kernel.arity(); });
    return made;
}

inline std::string text_of(const own_program& program)
{
    return program.parts.empty() ? std::string(program.text) : joined_source(program.parts) + std::string(program.text);
}

std::shared_ptr<compiled_kernel> opencl_commands::of_own(const own_program& program, const std::string& name)
{
    return of_text(text_of(program), name, program.options());
}

std::shared_ptr<compiled_kernel> opencl_commands::of_recording(const kernel_text& recorded, const std::string& text)
{
    return of_text(text, recorded.name, few_functions);
}

event opencl_commands::launch(compiled_kernel& kernel, std::span<const argument> arguments, const range& r)
{
    auto& compiled = static_cast<opencl_compiled&>(kernel);
    if (compiled.under_way) await(std::exchange(compiled.under_way, nullptr));
    for (std::size_t i = 0; i < arguments.size(); ++i)
    {
        const argument& a = arguments[i];
        try
        {
            compiled.kernel.set_arg(i, a.value_bytes(), a.value());
        }
        catch (const boost::compute::opencl_error& e)
        {
            throw command_failure{"argument " + std::to_string(i) + " of " + compiled.name + ": " + e.error_string() +
                                      " (the kernel expects another type than " + std::string(a.type()) + ")",
                                  e.error_code()};
        }
    }
    return event(std::make_shared<opencl_state>(told(
        [&] {
            return commands_.enqueue_nd_range_kernel(compiled.kernel, 1, nullptr, &r.global,
                                                     r.local ? &r.local : nullptr);
        })));
}

void opencl_commands::finish()
{
    told([&] { commands_.finish(); });
}

void opencl_commands::expect(const own_program& program)
{
    cache_.expect(text_of(program), program.options());
}

void opencl_commands::share(const std::string& text, const std::vector<std::string>& kernels)
{
    cache_.share(text, few_functions, kernels);
}

void opencl_commands::await(const queue_options::wait_for_build& elsewhere)
{
    do ask_between_builds();
    while (elsewhere && elsewhere());
}

} // namespace taut::impl
