# SPDX-License-Identifier: MIT
# taut_compile_quickly(<target>...): compiles tests and examples that compute little themselves unoptimised, and, where it is
# found, by clang++, which takes half of GCC's time for that. Extended tests are compiled by the compiler of the release.
set(taut_quick_flags $<$<CONFIG:Release>:-O0>)
set(taut_quick_compiler "")
if(TAUT_TESTS AND CMAKE_CXX_COMPILER_ID STREQUAL GNU AND NOT WIN32 AND NOT TAUT_EXTENDED)
    find_program(TAUT_QUICK_CXX NAMES clang++ clang++-14 clang++-15 clang++-16 clang++-19)
    if(TAUT_QUICK_CXX AND NOT DEFINED TAUT_QUICK_CXX_WORKS)
        file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/probe.cpp CONTENT "#include <vector>\nint main() {}\n")
        execute_process(COMMAND ${TAUT_QUICK_CXX} -std=c++20 probe.cpp -o probe WORKING_DIRECTORY ${PROJECT_BINARY_DIR}
                        RESULT_VARIABLE failure OUTPUT_QUIET ERROR_QUIET)
        if(failure EQUAL 0)
            set(TAUT_QUICK_CXX_WORKS TRUE CACHE INTERNAL "whether clang++ finds the standard library")
        endif()
    endif()
    if(TAUT_QUICK_CXX_WORKS)
        # A target has no compiler of its own; what starts GCC starts the other one in its place.
        list(JOIN CMAKE_CXX_COMPILER_LAUNCHER " " launcher)
        set(taut_quick_compiler ${CMAKE_CURRENT_LIST_DIR}/quick_compiler.sh "${launcher} ${TAUT_QUICK_CXX}")
    endif()
endif()

function(taut_compile_quickly)
    foreach(target ${ARGN})
        target_compile_options(${target} PRIVATE ${taut_quick_flags})
        if(taut_quick_compiler)
            set_target_properties(${target} PROPERTIES CXX_COMPILER_LAUNCHER "${taut_quick_compiler}")
        endif()
    endforeach()
endfunction()
