# SPDX-License-Identifier: MIT
# PoCL vectorises every element kernel and the gather: see vectorized.sh.
add_executable(taut_vectorized ${CMAKE_CURRENT_LIST_DIR}/vectorized.cpp)
target_include_directories(taut_vectorized PRIVATE ${PROJECT_SOURCE_DIR}/tests)
target_link_libraries(taut_vectorized PRIVATE taut_strict taut::taut)
taut_compile_quickly(taut_vectorized)
add_test(NAME device.vectorized
         COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/vectorized.sh $<TARGET_FILE:taut_vectorized>
                 ${CMAKE_BINARY_DIR}/pocl/vectorized)
set_tests_properties(device.vectorized PROPERTIES LABELS device SKIP_RETURN_CODE 77)
