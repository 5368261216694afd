// SPDX-License-Identifier: MIT
#pragma once

/// The version of the library, as a semantic version; CMake and the command line read it from here. A release
/// candidate has the numbers of its release, and -rc.N at the end of the string.
#define TAUT_VERSION_MAJOR 1
#define TAUT_VERSION_MINOR 0
#define TAUT_VERSION_PATCH 0
#define TAUT_VERSION_STRING "1.0.0-rc.1"
