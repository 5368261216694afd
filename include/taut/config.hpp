// SPDX-License-Identifier: MIT
#pragma once

/// Two forms of the library. Header-only, where every body comes with its header; or compiled, where TAUT_COMPILED is
/// defined in all files and bodies are in a library (CMake: taut::compiled), so that callers compile declarations only.
#ifdef TAUT_COMPILED
#define TAUT_INLINE
#else
#define TAUT_INLINE inline
#endif
