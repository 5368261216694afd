# SPDX-License-Identifier: MIT
# Kernel caches of tests. PoCL's is not safe between processes, and half of the kernels are those of several tests: a test has
# a cache of its own, or takes turns with its group, filled with what the device tests have compiled (support/kernels.sh).
# (Examples and Python's tests are no folders below this one.)
set(taut_kernels sh ${CMAKE_CURRENT_LIST_DIR}/support/kernels.sh ${CMAKE_BINARY_DIR}/pocl/shared CACHE INTERNAL "")

# What taut keeps for drivers that keep nothing is safe between processes: one folder for all.
set(taut_programs TAUT_CACHE_DIR=${CMAKE_BINARY_DIR}/programs CACHE INTERNAL "")

# A test with a cache of its own.
function(taut_own_kernel_cache test)
    string(MAKE_C_IDENTIFIER ${test} folder)
    file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/pocl/${folder})
    set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT "POCL_CACHE_DIR=${CMAKE_BINARY_DIR}/pocl/${folder}" ${taut_programs})
endfunction()

# taut_filled_kernel_cache(<name> <cache> <test>...): tests before which what device tests have compiled is added to a cache.
function(taut_filled_kernel_cache name cache)
    get_property(known GLOBAL PROPERTY taut_kernels_${name})
    if(NOT known)
        set_property(GLOBAL PROPERTY taut_kernels_${name} TRUE)
        add_test(NAME kernels.${name} COMMAND ${taut_kernels} ${cache})
        set_tests_properties(kernels.${name} PROPERTIES LABELS kernels FIXTURES_SETUP kernels_${name}
            RESOURCE_LOCK kernels_${name} DEPENDS "device.edit;device.map;device.objective;device.start;device.untangle")
    endif()
    set_property(TEST ${ARGN} APPEND PROPERTY FIXTURES_REQUIRED kernels_${name})
endfunction()

# taut_group_kernel_cache(<group> <test>...): tests that take turns with one cache.
function(taut_group_kernel_cache group)
    set(cache ${CMAKE_BINARY_DIR}/pocl/${group})
    file(MAKE_DIRECTORY ${cache})
    taut_filled_kernel_cache(${group} ${cache} ${ARGN})
    foreach(test ${ARGN})
        set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT "POCL_CACHE_DIR=${cache}" ${taut_programs})
        set_property(TEST ${test} APPEND PROPERTY RESOURCE_LOCK kernels_${group})
        set_property(TEST ${test} PROPERTY COST 10) # what takes turns begins early, so that no turns are left at the end
    endforeach()
endfunction()
