# SPDX-License-Identifier: MIT
# taut::taut: the headers and the bodies of all, in several units at a time, built by those who link it. The units lie in
# src/, here and where taut is installed.
set(taut_source_dir ${CMAKE_CURRENT_LIST_DIR}/src)
if(NOT EXISTS ${taut_source_dir})
    set(taut_source_dir ${CMAKE_CURRENT_LIST_DIR}/../src)
endif()
file(GLOB taut_sources ${taut_source_dir}/*.cpp)
list(FILTER taut_sources EXCLUDE REGEX "/dist[^/]*.cpp$") # of a library of its own (dist.cmake)
find_package(nlohmann_json QUIET)
if(NOT nlohmann_json_FOUND)
    list(FILTER taut_sources EXCLUDE REGEX "/gltf.cpp$") # glTF is JSON
endif()
find_package(Eigen3 QUIET NO_MODULE)
if(NOT TARGET Eigen3::Eigen)
    list(FILTER taut_sources EXCLUDE REGEX "/paste.cpp$") # its systems are solved by Eigen
endif()
add_library(taut STATIC EXCLUDE_FROM_ALL ${taut_sources})
set_target_properties(taut PROPERTIES POSITION_INDEPENDENT_CODE ON) # for shared libraries, as a module of Python
add_library(taut::taut ALIAS taut)
target_link_libraries(taut PUBLIC taut::headers)
if(nlohmann_json_FOUND)
    target_link_libraries(taut PRIVATE $<BUILD_INTERFACE:nlohmann_json::nlohmann_json>)
endif()
if(TARGET Eigen3::Eigen)
    target_link_libraries(taut PRIVATE $<BUILD_INTERFACE:Eigen3::Eigen>)
endif()
