// SPDX-License-Identifier: MIT
#pragma once

/// The version of the library; CMake and the command line read it from here.
#define TAUT_VERSION_MAJOR 0
#define TAUT_VERSION_MINOR 1
#define TAUT_VERSION_PATCH 0
#define TAUT_VERSION_STRING "0.1.0"
