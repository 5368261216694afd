# SPDX-License-Identifier: MIT
# What the headers need: GLM and threads, and where OpenCL's devices are to be seen its headers and Boost's, of
# Boost.Compute. OpenCL's library is no part of it: it is opened when a program asks for it
# (taut/impl/core/compute/opencl/library.hpp).
find_path(OpenCL_INCLUDE_DIR CL/cl.h)
mark_as_advanced(OpenCL_INCLUDE_DIR)
find_package(Boost 1.71 QUIET)
set(taut_opencl_headers "")
if(OpenCL_INCLUDE_DIR AND Boost_FOUND)
    set(taut_opencl_headers ${OpenCL_INCLUDE_DIR} ${Boost_INCLUDE_DIRS})
endif()
find_package(glm REQUIRED)
find_package(Threads REQUIRED)
if(NOT TARGET glm::glm)
    add_library(glm::glm INTERFACE IMPORTED)
    set_target_properties(glm::glm PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${GLM_INCLUDE_DIRS}")
endif()
