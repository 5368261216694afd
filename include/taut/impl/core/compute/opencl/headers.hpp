// SPDX-License-Identifier: MIT
#pragma once

// OpenCL's headers, as Boost.Compute includes them. As system headers they keep their warnings out of the user's build.
#if defined(__GNUC__)
#pragma GCC system_header
#endif

// OpenCL 1.2 is what every driver in use offers; the pin keeps the header from warning about newer versions.
#ifndef CL_TARGET_OPENCL_VERSION
#define CL_TARGET_OPENCL_VERSION 120
#endif
// What Boost.Compute may use of it: 1.2, whatever the pin. It refuses 102 beside another pin, and takes 103 for the
// same.
#ifndef BOOST_COMPUTE_MAX_CL_VERSION
#if CL_TARGET_OPENCL_VERSION == 120
#define BOOST_COMPUTE_MAX_CL_VERSION 102
#else
#define BOOST_COMPUTE_MAX_CL_VERSION 103
#endif
#endif

#include <boost/compute/cl.hpp>
#include <boost/compute/cl_ext.hpp>
