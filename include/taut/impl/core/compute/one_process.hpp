// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

#include <taut/device.hpp>

namespace taut::impl
{

/// Returns whether a parent of this process has used OpenCL before it called fork(). Drivers have threads, which the
/// child has not: it would wait for them for ever. The first call says which process uses OpenCL.
inline bool made_by_fork()
{
#if defined(__unix__) || defined(__APPLE__)
    static const ::pid_t first = ::getpid();
    return ::getpid() != first;
#else
    return false;
#endif
}

/// device: its label, if it is known. Throws device_error.
inline void refuse_fork(const std::string& operation, const std::string& device = "not opened")
{
    if (made_by_fork())
        throw device_error(operation,
                           "this process was made by fork() after its parent had used OpenCL, whose drivers do not "
                           "survive that; fork before the first queue and list of devices, or start a program (exec)",
                           device);
}

} // namespace taut::impl
