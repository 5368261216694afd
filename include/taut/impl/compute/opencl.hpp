// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/compute/cl.hpp>

// The one include of OpenCL and Boost.Compute. As a system header it keeps their warnings out of the user's build.
#if defined(__GNUC__)
#pragma GCC system_header
#endif

// The highest version that Boost.Compute may use.
#ifndef BOOST_COMPUTE_MAX_CL_VERSION // of 210, 201
#define BOOST_COMPUTE_MAX_CL_VERSION (CL_TARGET_OPENCL_VERSION / 100 * 100 + CL_TARGET_OPENCL_VERSION % 100 / 10)
#endif

// Five headers, not core.hpp: half the compile time, and none that newer Boost releases have broken.
#include <boost/compute/buffer.hpp>
#include <boost/compute/command_queue.hpp>
#include <boost/compute/kernel.hpp>
#include <boost/compute/program.hpp>
#include <boost/compute/system.hpp>
