# SPDX-License-Identifier: MIT
# What the headers need: OpenCL, Boost (headers only, for Boost.Compute), GLM and threads.
find_package(OpenCL REQUIRED)
find_package(Boost 1.71 REQUIRED)
find_package(glm REQUIRED)
find_package(Threads REQUIRED)
if(NOT TARGET glm::glm)
    add_library(glm::glm INTERFACE IMPORTED)
    set_target_properties(glm::glm PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${GLM_INCLUDE_DIRS}")
endif()
