// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <utility>

#include <taut/impl/compute/opencl.hpp>

namespace taut
{

/// The completion of one command. A default-constructed event stands for no command at all and is complete.
class event
{
public:
    event() = default;
    explicit event(boost::compute::event handle) : handle_(std::move(handle)) {}

    /// Blocks until the command has run. Each wait costs as much as seven to ten launches: wait for the last command of
    /// a queue, not for each.
    void wait() const
    {
        if (handle_.get()) handle_.wait();
    }

    bool complete() const
    {
        return !handle_.get() || handle_.get_info<cl_int>(CL_EVENT_COMMAND_EXECUTION_STATUS) == CL_COMPLETE;
    }

    /// Seconds between the command's start and end on the device; nothing unless the queue was made with profiling.
    std::optional<double> seconds() const
    {
        cl_ulong start = 0, end = 0;
        if (!handle_.get() ||
            clGetEventProfilingInfo(handle_.get(), CL_PROFILING_COMMAND_START, sizeof start, &start, nullptr) !=
                CL_SUCCESS ||
            clGetEventProfilingInfo(handle_.get(), CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr) != CL_SUCCESS)
            return std::nullopt;
        return 1e-9 * static_cast<double>(end - start);
    }

    cl_event native() const { return handle_.get(); }

private:
    boost::compute::event handle_;
};

} // namespace taut
