# SPDX-License-Identifier: MIT
# The compiled form: bodies in a library, in several units, and declarations only for those who link it.
file(GLOB taut_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*.cpp)
add_library(taut_compiled STATIC ${taut_sources})
add_library(taut::compiled ALIAS taut_compiled)
set_target_properties(taut_compiled PROPERTIES OUTPUT_NAME taut EXPORT_NAME compiled)
target_compile_definitions(taut_compiled PUBLIC TAUT_COMPILED)
target_link_libraries(taut_compiled PUBLIC taut::taut)
