# SPDX-License-Identifier: MIT
# Tests of the compute layer that are not a plain run of taut_test_device_compute.

# Embedded kernels are fresh, and valid OpenCL C 1.2.
add_test(NAME house.kernels COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/kernels_check/check)

# A machine without any OpenCL driver.
set(taut_no_drivers ${CMAKE_CURRENT_BINARY_DIR}/no-opencl-drivers)
file(MAKE_DIRECTORY ${taut_no_drivers})
add_test(NAME device.no_platform
         COMMAND ${CMAKE_COMMAND} "-DEXPECTED=test cases: +1 . +1 passed . 0 failed" -P ${CMAKE_CURRENT_SOURCE_DIR}/says.cmake --
                 $<TARGET_FILE:taut_test_device_compute> --no-skip "--test-case=devices: without an OpenCL platform*")
set_tests_properties(device.no_platform PROPERTIES LABELS device ENVIRONMENT "OCL_ICD_VENDORS=${taut_no_drivers}/")

# Several devices: PoCL shows as many as it is asked for.
add_test(NAME device.several COMMAND taut_test_device_compute "--test-case=devices:*,queue:*")
set_tests_properties(device.several PROPERTIES LABELS device ENVIRONMENT
    "POCL_DEVICES=pthread pthread basic;TAUT_DEVICE=2;POCL_CACHE_DIR=${CMAKE_BINARY_DIR}/pocl/several"
    SKIP_REGULAR_EXPRESSION "no device fits TAUT_DEVICE=2")
set_tests_properties(house.kernels PROPERTIES SKIP_RETURN_CODE 77)
