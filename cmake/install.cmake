# SPDX-License-Identifier: MIT
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
set(taut_config_dir ${CMAKE_INSTALL_DATADIR}/cmake/taut)

install(TARGETS taut_headers EXPORT taut-targets)
install(DIRECTORY include/taut DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT taut-targets NAMESPACE taut:: DESTINATION ${taut_config_dir})
configure_package_config_file(cmake/taut-config.cmake.in ${PROJECT_BINARY_DIR}/taut-config.cmake
                              INSTALL_DESTINATION ${taut_config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/taut-config-version.cmake
                                 COMPATIBILITY SameMajorVersion ARCH_INDEPENDENT)
install(DIRECTORY src DESTINATION ${taut_config_dir})
install(FILES cmake/dependencies.cmake cmake/compression.cmake cmake/bodies.cmake cmake/components.cmake cmake/dist.cmake
              ${PROJECT_BINARY_DIR}/taut-config.cmake
              ${PROJECT_BINARY_DIR}/taut-config-version.cmake
        DESTINATION ${taut_config_dir})

# taut.pc: of the headers; one file of a program defines TAUT_IMPLEMENTATION.
set(taut_pc_dir ${CMAKE_INSTALL_DATADIR}/pkgconfig)
file(RELATIVE_PATH taut_pc_to_prefix /prefix/${taut_pc_dir} /prefix)
string(REGEX REPLACE "/$" "" taut_pc_to_prefix "${taut_pc_to_prefix}")
configure_file(cmake/taut.pc.in ${PROJECT_BINARY_DIR}/taut.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/taut.pc DESTINATION ${taut_pc_dir})
