# SPDX-License-Identifier: MIT
# The compiled form: bodies in a library of several units, built by those who link it, and declarations only for them.
# The sources lie in src/, here and where taut is installed.
file(GLOB taut_sources ${CMAKE_CURRENT_LIST_DIR}/../src/*.cpp ${CMAKE_CURRENT_LIST_DIR}/src/*.cpp)
add_library(taut_compiled STATIC EXCLUDE_FROM_ALL ${taut_sources})
add_library(taut::compiled ALIAS taut_compiled)
target_compile_definitions(taut_compiled PUBLIC TAUT_COMPILED)
target_link_libraries(taut_compiled PUBLIC taut::taut)
