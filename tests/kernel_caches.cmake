# SPDX-License-Identifier: MIT
# taut_test_on_pocl(<test>): runs a test on PoCL, which must be installed, rather than on the best device. PoCL's cache of
# kernels is not safe between processes: the test has one of its own. (Examples and Python's tests are no folders below.)
function(taut_test_on_pocl test)
    string(MAKE_C_IDENTIFIER ${test} folder)
    set(cache ${CMAKE_BINARY_DIR}/pocl/${folder})
    file(MAKE_DIRECTORY ${cache})
    set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT TAUT_DEVICE=portable "POCL_CACHE_DIR=${cache}")
    set_property(TEST ${test} PROPERTY SKIP_REGULAR_EXPRESSION "no device fits TAUT_DEVICE=portable")
endfunction()
