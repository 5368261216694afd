// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/compute/program/own_program.hpp>
#include <taut/kernel.hpp>

namespace taut::impl
{

/// A command that a device refused; the queue tells which, and where.
struct command_failure
{
    std::string reason;
    int code = 0; ///< of OpenCL
};

/// A kernel as a device has compiled it.
class compiled_kernel
{
public:
    virtual ~compiled_kernel() = default;
    /// Number of its arguments.
    virtual std::size_t arguments() const = 0;
};

/// What a queue asks of a device; commands run in their order. There are two models, OpenCL's (opencl_commands) and the
/// host's (host_commands). Functions that do not say otherwise throw command_failure.
class device_commands
{
public:
    device_commands() = default;
    device_commands(const device_commands&) = delete;
    device_commands& operator=(const device_commands&) = delete;
    virtual ~device_commands() = default;

    /// values: of so many bytes, or null.
    virtual memory_handle allocate(std::size_t bytes, const void* values) = 0;
    virtual void release(memory_handle memory) noexcept = 0;

    virtual void write(memory_handle to, std::size_t offset, std::size_t bytes, const void* values) = 0;
    /// Without a wait, values are there after the next command that waits.
    virtual void read(memory_handle from, std::size_t offset, std::size_t bytes, void* values, bool wait) = 0;
    virtual void fill(memory_handle memory, std::size_t bytes, const void* value, std::size_t value_bytes) = 0;
    virtual void copy(memory_handle from, memory_handle to, std::size_t offset, std::size_t bytes) = 0;

    /// A kernel of OpenCL C of the user's, of taut's own programs, and as it was recorded, text being the program that
    /// it is in. Throw build_error, device_error.
    virtual std::shared_ptr<compiled_kernel> of_text(const std::string& text, const std::string& name,
                                                     const std::string& options) = 0;
    virtual std::shared_ptr<compiled_kernel> of_own(const own_program& program, const std::string& name) = 0;
    virtual std::shared_ptr<compiled_kernel> of_recording(const kernel_text& recorded, const std::string& text) = 0;

    /// r.local is never 0, but where the driver is to choose.
    virtual event launch(compiled_kernel& kernel, std::span<const argument> arguments, const range& r) = 0;

    virtual void finish() = 0;

    /// A place of memory that this device and another one share, if they do.
    virtual const void* memory_space() const noexcept = 0;

    /// A program that will be needed, and kernels of one that are: see queue_options::build_elsewhere.
    virtual void expect(const own_program&) {}
    virtual void share(const std::string& /*text*/, const std::vector<std::string>& /*kernels*/) {}

    /// Programs that were built, and how long it took.
    virtual std::size_t builds() const noexcept { return 0; }
    virtual double build_seconds() const noexcept { return 0; }

    /// Null where the device is none of OpenCL's.
    virtual cl_command_queue native() const noexcept { return nullptr; }
    virtual cl_context native_context() const noexcept { return nullptr; }

    /// Waits, whatever comes of it.
    void settle() noexcept
    {
        try
        {
            finish();
        }
        catch (...)
        {
            // The next command will say so.
        }
    }

    /// While it is set, it is called before each kernel is looked up and each launch, once the device is idle: for
    /// warm-ups, in which drivers compile for seconds. What it throws passes through.
    std::function<void()> between_builds;

    void ask_between_builds()
    {
        if (!between_builds) return;
        settle();
        between_builds();
    }
};

} // namespace taut::impl
