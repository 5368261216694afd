// SPDX-License-Identifier: MIT
#pragma once

/// The headers are all there is to the library, and each source file compiles what it uses. In a project of many files,
/// TAUT_SEPARATE makes the largest functions declarations; one file of the project then compiles them by including
/// map/parameterization.hpp and map/untangle/untangle_on_device.hpp (with CMake: link taut::separate, which is that).
#ifdef TAUT_SEPARATE
#define TAUT_INLINE
#else
#define TAUT_INLINE inline
#endif
