# SPDX-License-Identifier: MIT
# taut::core, taut::files and taut::charts: the headers and the bodies of one house each, in several units at a time, built
# by those who link them; taut::taut: all three. The units lie in src/, here and where taut is installed.
set(taut_source_dir ${CMAKE_CURRENT_LIST_DIR}/src)
if(NOT EXISTS ${taut_source_dir})
    set(taut_source_dir ${CMAKE_CURRENT_LIST_DIR}/../src)
endif()
find_package(nlohmann_json QUIET)
find_package(Eigen3 QUIET NO_MODULE)
set(taut_houses core files charts)
foreach(house ${taut_houses})
    file(GLOB taut_units ${taut_source_dir}/${house}/*.cpp)
    if(NOT nlohmann_json_FOUND)
        list(FILTER taut_units EXCLUDE REGEX "/gltf.cpp$") # glTF is JSON
    endif()
    if(NOT TARGET Eigen3::Eigen)
        list(FILTER taut_units EXCLUDE REGEX "/paste.cpp$") # its systems are solved by Eigen
    endif()
    add_library(taut_${house} STATIC EXCLUDE_FROM_ALL ${taut_units})
    set_target_properties(taut_${house} PROPERTIES POSITION_INDEPENDENT_CODE ON) # for shared libraries, as a module of Python
    add_library(taut::${house} ALIAS taut_${house})
    target_link_libraries(taut_${house} PUBLIC taut::headers)
endforeach()
target_link_libraries(taut_files PUBLIC taut::core)
target_link_libraries(taut_charts PUBLIC taut::files)
if(nlohmann_json_FOUND)
    target_link_libraries(taut_files PRIVATE $<BUILD_INTERFACE:nlohmann_json::nlohmann_json>)
endif()
if(TARGET Eigen3::Eigen)
    target_link_libraries(taut_charts PRIVATE $<BUILD_INTERFACE:Eigen3::Eigen>)
endif()
add_library(taut INTERFACE)
add_library(taut::taut ALIAS taut)
target_link_libraries(taut INTERFACE taut::charts)
