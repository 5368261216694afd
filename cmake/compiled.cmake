# SPDX-License-Identifier: MIT
# The compiled form: bodies in a library of several units, built by those who link it, and declarations only for them.
# The sources lie in src/, here and where taut is installed.
set(taut_source_dir ${CMAKE_CURRENT_LIST_DIR}/src)
if(NOT EXISTS ${taut_source_dir})
    set(taut_source_dir ${CMAKE_CURRENT_LIST_DIR}/../src)
endif()
file(GLOB taut_sources ${taut_source_dir}/*.cpp)
add_library(taut_compiled STATIC EXCLUDE_FROM_ALL ${taut_sources})
add_library(taut::compiled ALIAS taut_compiled)
target_compile_definitions(taut_compiled PUBLIC TAUT_COMPILED)
target_link_libraries(taut_compiled PUBLIC taut::taut)
