# SPDX-License-Identifier: MIT
# What TAUT_SEPARATE leaves out of the files that include it, compiled once for those who link this.
add_library(taut_separate STATIC EXCLUDE_FROM_ALL ${CMAKE_CURRENT_LIST_DIR}/separate.cpp)
add_library(taut::separate ALIAS taut_separate)
target_compile_definitions(taut_separate PUBLIC TAUT_SEPARATE)
target_link_libraries(taut_separate PUBLIC taut::taut)
