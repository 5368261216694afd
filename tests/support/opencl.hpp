// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/impl/core/compute/opencl/commands.hpp>
#include <taut/impl/core/compute/queue_state.hpp>
#include <taut/queue.hpp>

namespace taut::test
{

/// OpenCL's functions, of a process in which a device of it was found.
inline const impl::opencl_library& cl()
{
    return impl::opencl_library::get();
}

/// The programs of a queue on an OpenCL device.
inline impl::program_cache& cache_of(const queue& q)
{
    return dynamic_cast<impl::opencl_commands&>(*impl::state_of(q)->commands).cache();
}

/// Options with which the program of a kernel was built.
inline std::string build_options(const queue& q, const std::string& source, const std::string& name,
                                 const std::string& options)
{
    return cache_of(q)
        .find(source, name, options)
        .get_program()
        .get_build_info<std::string>(CL_PROGRAM_BUILD_OPTIONS, boost::compute::device(q.device().native()));
}

} // namespace taut::test
