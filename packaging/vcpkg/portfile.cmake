# SPDX-License-Identifier: MIT
vcpkg_download_distfile(archive
    URLS "https://taut.example/releases/taut-${VERSION}.tar.gz"
    FILENAME "taut-${VERSION}.tar.gz"
    SHA512 0)
vcpkg_extract_source_archive(SOURCE_PATH ARCHIVE "${archive}")

set(program -DTAUT_TOOLS=OFF)
if("cli" IN_LIST FEATURES)
    set(program -DTAUT_TOOLS=ON)
endif()
set(VCPKG_BUILD_TYPE release) # headers, and sources of their bodies
vcpkg_cmake_configure(
    SOURCE_PATH "${SOURCE_PATH}"
    OPTIONS -DTAUT_TESTS=OFF -DTAUT_EXAMPLES=OFF -DTAUT_BENCH=OFF -DTAUT_MPI=OFF ${program})
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME taut CONFIG_PATH share/cmake/taut)
vcpkg_fixup_pkgconfig()
if("cli" IN_LIST FEATURES)
    vcpkg_copy_tools(TOOL_NAMES taut AUTO_CLEAN)
endif()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/lib" "${CURRENT_PACKAGES_DIR}/debug")
file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE" "${SOURCE_PATH}/THIRD_PARTY.md")
