// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/compute/opencl/headers.hpp>

namespace taut::impl
{

/// The functions of OpenCL 1.2 that taut and what it uses of Boost.Compute call.
#define TAUT_OPENCL_FUNCTIONS(F)                                                                                       \
    F(clGetPlatformIDs)                                                                                                \
    F(clGetPlatformInfo)                                                                                               \
    F(clGetDeviceIDs)                                                                                                  \
    F(clGetDeviceInfo)                                                                                                 \
    F(clRetainDevice)                                                                                                  \
    F(clReleaseDevice)                                                                                                 \
    F(clCreateContext)                                                                                                 \
    F(clRetainContext)                                                                                                 \
    F(clReleaseContext)                                                                                                \
    F(clGetContextInfo)                                                                                                \
    F(clCreateCommandQueue)                                                                                            \
    F(clRetainCommandQueue)                                                                                            \
    F(clReleaseCommandQueue)                                                                                           \
    F(clGetCommandQueueInfo)                                                                                           \
    F(clFinish)                                                                                                        \
    F(clCreateBuffer)                                                                                                  \
    F(clRetainMemObject)                                                                                               \
    F(clReleaseMemObject)                                                                                              \
    F(clGetMemObjectInfo)                                                                                              \
    F(clEnqueueReadBuffer)                                                                                             \
    F(clEnqueueWriteBuffer)                                                                                            \
    F(clEnqueueFillBuffer)                                                                                             \
    F(clEnqueueCopyBuffer)                                                                                             \
    F(clEnqueueNDRangeKernel)                                                                                          \
    F(clCreateProgramWithSource)                                                                                       \
    F(clCreateProgramWithBinary)                                                                                       \
    F(clBuildProgram)                                                                                                  \
    F(clGetProgramInfo)                                                                                                \
    F(clGetProgramBuildInfo)                                                                                           \
    F(clRetainProgram)                                                                                                 \
    F(clReleaseProgram)                                                                                                \
    F(clCreateKernel)                                                                                                  \
    F(clGetKernelInfo)                                                                                                 \
    F(clSetKernelArg)                                                                                                  \
    F(clRetainKernel)                                                                                                  \
    F(clReleaseKernel)                                                                                                 \
    F(clWaitForEvents)                                                                                                 \
    F(clGetEventInfo)                                                                                                  \
    F(clGetEventProfilingInfo)                                                                                         \
    F(clRetainEvent)                                                                                                   \
    F(clReleaseEvent)

/// They are found when they are first wanted, so that a program starts where no loader of drivers is installed.
struct opencl_library
{
#define TAUT_OPENCL_MEMBER(name) decltype(&::name) name = nullptr;
    TAUT_OPENCL_FUNCTIONS(TAUT_OPENCL_MEMBER)
#undef TAUT_OPENCL_MEMBER

    /// Null where there is no such library. Never closed: drivers have threads.
    static const opencl_library* find();

    /// Throws device_error where there is none.
    static const opencl_library& get();
};

} // namespace taut::impl
