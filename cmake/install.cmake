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
                                 COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(DIRECTORY src DESTINATION ${taut_config_dir})
install(FILES cmake/dependencies.cmake cmake/compression.cmake cmake/bodies.cmake
              ${PROJECT_BINARY_DIR}/taut-config.cmake
              ${PROJECT_BINARY_DIR}/taut-config-version.cmake
        DESTINATION ${taut_config_dir})
