// SPDX-License-Identifier: MIT
#pragma once

// The one include of Boost.Compute. As a system header it keeps its warnings out of the user's build.
#if defined(__GNUC__)
#pragma GCC system_header
#endif

#include <taut/impl/core/compute/opencl/library.hpp>

// Boost.Compute calls OpenCL's functions by their names, which stand for the table's here: no library of OpenCL is
// linked. One that the table lacks is undefined to the linker.
#define TAUT_OPENCL_CALL(name) (*::taut::impl::opencl_library::get().name)
#define clGetPlatformIDs TAUT_OPENCL_CALL(clGetPlatformIDs)
#define clGetPlatformInfo TAUT_OPENCL_CALL(clGetPlatformInfo)
#define clGetDeviceIDs TAUT_OPENCL_CALL(clGetDeviceIDs)
#define clGetDeviceInfo TAUT_OPENCL_CALL(clGetDeviceInfo)
#define clRetainDevice TAUT_OPENCL_CALL(clRetainDevice)
#define clReleaseDevice TAUT_OPENCL_CALL(clReleaseDevice)
#define clCreateContext TAUT_OPENCL_CALL(clCreateContext)
#define clRetainContext TAUT_OPENCL_CALL(clRetainContext)
#define clReleaseContext TAUT_OPENCL_CALL(clReleaseContext)
#define clGetContextInfo TAUT_OPENCL_CALL(clGetContextInfo)
#define clCreateCommandQueue TAUT_OPENCL_CALL(clCreateCommandQueue)
#define clRetainCommandQueue TAUT_OPENCL_CALL(clRetainCommandQueue)
#define clReleaseCommandQueue TAUT_OPENCL_CALL(clReleaseCommandQueue)
#define clGetCommandQueueInfo TAUT_OPENCL_CALL(clGetCommandQueueInfo)
#define clFinish TAUT_OPENCL_CALL(clFinish)
#define clCreateBuffer TAUT_OPENCL_CALL(clCreateBuffer)
#define clRetainMemObject TAUT_OPENCL_CALL(clRetainMemObject)
#define clReleaseMemObject TAUT_OPENCL_CALL(clReleaseMemObject)
#define clGetMemObjectInfo TAUT_OPENCL_CALL(clGetMemObjectInfo)
#define clEnqueueReadBuffer TAUT_OPENCL_CALL(clEnqueueReadBuffer)
#define clEnqueueWriteBuffer TAUT_OPENCL_CALL(clEnqueueWriteBuffer)
#define clEnqueueFillBuffer TAUT_OPENCL_CALL(clEnqueueFillBuffer)
#define clEnqueueCopyBuffer TAUT_OPENCL_CALL(clEnqueueCopyBuffer)
#define clEnqueueNDRangeKernel TAUT_OPENCL_CALL(clEnqueueNDRangeKernel)
#define clCreateProgramWithSource TAUT_OPENCL_CALL(clCreateProgramWithSource)
#define clCreateProgramWithBinary TAUT_OPENCL_CALL(clCreateProgramWithBinary)
#define clBuildProgram TAUT_OPENCL_CALL(clBuildProgram)
#define clGetProgramInfo TAUT_OPENCL_CALL(clGetProgramInfo)
#define clGetProgramBuildInfo TAUT_OPENCL_CALL(clGetProgramBuildInfo)
#define clRetainProgram TAUT_OPENCL_CALL(clRetainProgram)
#define clReleaseProgram TAUT_OPENCL_CALL(clReleaseProgram)
#define clCreateKernel TAUT_OPENCL_CALL(clCreateKernel)
#define clGetKernelInfo TAUT_OPENCL_CALL(clGetKernelInfo)
#define clSetKernelArg TAUT_OPENCL_CALL(clSetKernelArg)
#define clRetainKernel TAUT_OPENCL_CALL(clRetainKernel)
#define clReleaseKernel TAUT_OPENCL_CALL(clReleaseKernel)
#define clWaitForEvents TAUT_OPENCL_CALL(clWaitForEvents)
#define clGetEventInfo TAUT_OPENCL_CALL(clGetEventInfo)
#define clGetEventProfilingInfo TAUT_OPENCL_CALL(clGetEventProfilingInfo)
#define clRetainEvent TAUT_OPENCL_CALL(clRetainEvent)
#define clReleaseEvent TAUT_OPENCL_CALL(clReleaseEvent)

// These, not core.hpp: half the compile time, and none that newer Boost releases have broken.
#include <boost/compute/buffer.hpp>
#include <boost/compute/command_queue.hpp>
#include <boost/compute/context.hpp>
#include <boost/compute/device.hpp>
#include <boost/compute/event.hpp>
#include <boost/compute/kernel.hpp>
#include <boost/compute/platform.hpp>
#include <boost/compute/program.hpp>
#include <boost/compute/system.hpp>

#undef TAUT_OPENCL_CALL
#undef clGetPlatformIDs
#undef clGetPlatformInfo
#undef clGetDeviceIDs
#undef clGetDeviceInfo
#undef clRetainDevice
#undef clReleaseDevice
#undef clCreateContext
#undef clRetainContext
#undef clReleaseContext
#undef clGetContextInfo
#undef clCreateCommandQueue
#undef clRetainCommandQueue
#undef clReleaseCommandQueue
#undef clGetCommandQueueInfo
#undef clFinish
#undef clCreateBuffer
#undef clRetainMemObject
#undef clReleaseMemObject
#undef clGetMemObjectInfo
#undef clEnqueueReadBuffer
#undef clEnqueueWriteBuffer
#undef clEnqueueFillBuffer
#undef clEnqueueCopyBuffer
#undef clEnqueueNDRangeKernel
#undef clCreateProgramWithSource
#undef clCreateProgramWithBinary
#undef clBuildProgram
#undef clGetProgramInfo
#undef clGetProgramBuildInfo
#undef clRetainProgram
#undef clReleaseProgram
#undef clCreateKernel
#undef clGetKernelInfo
#undef clSetKernelArg
#undef clRetainKernel
#undef clReleaseKernel
#undef clWaitForEvents
#undef clGetEventInfo
#undef clGetEventProfilingInfo
#undef clRetainEvent
#undef clReleaseEvent
