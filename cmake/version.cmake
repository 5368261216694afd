# SPDX-License-Identifier: MIT
# The version stands in include/taut/version.hpp alone: taut_version is 1.0.0, what CMake compares; taut_full_version has
# what stands behind it, too, as in 1.0.0-rc.1.
file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/../include/taut/version.hpp taut_version_lines REGEX "^#define TAUT_VERSION_")
string(REGEX MATCH "STRING \"(([0-9]+\\.[0-9]+\\.[0-9]+)(-[0-9A-Za-z.-]+)?)\"" taut_version_match "${taut_version_lines}")
set(taut_full_version "${CMAKE_MATCH_1}")
set(taut_version "${CMAKE_MATCH_2}")
set(taut_version_numbers "")
foreach(part MAJOR MINOR PATCH)
    string(REGEX MATCH "VERSION_${part} ([0-9]+)" taut_version_match "${taut_version_lines}")
    list(APPEND taut_version_numbers "${CMAKE_MATCH_1}")
endforeach()
list(JOIN taut_version_numbers "." taut_version_numbers)
if(NOT taut_version OR NOT taut_version STREQUAL taut_version_numbers)
    message(FATAL_ERROR "include/taut/version.hpp: TAUT_VERSION_STRING \"${taut_full_version}\" is not of version "
                        "${taut_version_numbers}")
endif()
