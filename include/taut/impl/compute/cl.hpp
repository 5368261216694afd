// SPDX-License-Identifier: MIT
#pragma once

// OpenCL's own header, which callers of the compiled form need and no more.
#if defined(__GNUC__)
#pragma GCC system_header
#endif

// OpenCL 1.2 is what every driver in use offers; the pin keeps the header from warning about newer versions.
#ifndef CL_TARGET_OPENCL_VERSION
#define CL_TARGET_OPENCL_VERSION 120
#endif

#include <CL/cl.h>
