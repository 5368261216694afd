// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <taut/impl/core/compute/commands.hpp>
#include <taut/impl/core/compute/program_cache.hpp>

namespace taut::impl
{

/// Commands of an OpenCL device: an in-order queue of a context.
class opencl_commands : public device_commands
{
public:
    /// quick, elsewhere: see queue_options.
    opencl_commands(const taut::device& d, boost::compute::context context, boost::compute::command_queue commands,
                    bool quick, queue_options::builder elsewhere);

    /// Waits: PoCL compiles at launch, on threads of its own, and crashes if the process ends meanwhile. In a child
    /// that fork() has made there are none, so that the queue is left as it is.
    ~opencl_commands() override;

    memory_handle allocate(std::size_t bytes, const void* values) override;
    void release(memory_handle memory) noexcept override;
    void write(memory_handle to, std::size_t offset, std::size_t bytes, const void* values) override;
    void read(memory_handle from, std::size_t offset, std::size_t bytes, void* values, bool wait) override;
    void fill(memory_handle memory, std::size_t bytes, const void* value, std::size_t value_bytes) override;
    void copy(memory_handle from, memory_handle to, std::size_t offset, std::size_t bytes) override;

    std::shared_ptr<compiled_kernel> of_text(const std::string& text, const std::string& name,
                                             const std::string& options) override;
    std::shared_ptr<compiled_kernel> of_own(const own_program& program, const std::string& name) override;
    std::shared_ptr<compiled_kernel> of_recording(const kernel_text& recorded, const std::string& text) override;
    event launch(compiled_kernel& kernel, std::span<const argument> arguments, const range& r) override;

    void finish() override;
    const void* memory_space() const noexcept override { return context_.get(); }

    void expect(const own_program& program) override;
    void share(const std::string& text, const std::vector<std::string>& kernels) override;
    std::size_t builds() const noexcept override { return cache_.builds(); }
    double build_seconds() const noexcept override { return cache_.seconds(); }
    cl_command_queue native() const noexcept override { return commands_.get(); }
    cl_context native_context() const noexcept override { return context_.get(); }

    program_cache& cache() noexcept { return cache_; }

private:
    /// Waits for kernel builds of other processes.
    void await(const queue_options::wait_for_build& elsewhere);

    boost::compute::context context_;
    boost::compute::command_queue commands_;
    program_cache cache_;
};

} // namespace taut::impl
