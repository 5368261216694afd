// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include <taut/impl/core/compute/commands.hpp>

namespace taut::impl
{

/// Commands of the host itself: memory is that of the process, and a command has run when its call returns. Launches
/// are shared by the threads of the process; results do not depend on their number.
class host_commands : public device_commands
{
public:
    /// label: as messages quote the device.
    host_commands(std::string label, bool profiling) : label_(std::move(label)), profiling_(profiling) {}

    memory_handle allocate(std::size_t bytes, const void* values) override;
    void release(memory_handle memory) noexcept override;
    void write(memory_handle to, std::size_t offset, std::size_t bytes, const void* values) override;
    void read(memory_handle from, std::size_t offset, std::size_t bytes, void* values, bool wait) override;
    void fill(memory_handle memory, std::size_t bytes, const void* value, std::size_t value_bytes) override;
    void copy(memory_handle from, memory_handle to, std::size_t offset, std::size_t bytes) override;

    /// Throws build_error: there is no compiler.
    std::shared_ptr<compiled_kernel> of_text(const std::string& text, const std::string& name,
                                             const std::string& options) override;
    std::shared_ptr<compiled_kernel> of_own(const own_program& program, const std::string& name) override;
    std::shared_ptr<compiled_kernel> of_recording(const kernel_text& recorded, const std::string& text) override;
    event launch(compiled_kernel& kernel, std::span<const argument> arguments, const range& r) override;

    void finish() override {}
    const void* memory_space() const noexcept override;

private:
    std::string label_;
    bool profiling_;
};

} // namespace taut::impl
