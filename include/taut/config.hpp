// SPDX-License-Identifier: MIT
#pragma once

/// Two forms of the library. Header-only, where every body comes with its header; or compiled, where TAUT_COMPILED is
/// defined in all files and bodies are in a library (CMake: taut::compiled), so that callers compile declarations only.
///
/// TAUT_INLINE: before a body that both forms have. TAUT_ON_USE, and TAUT_ON_USE_BODY before its body: a function that
/// costs much to compile. Header-only it is a template, which only files that call it compile.
#ifdef TAUT_COMPILED
#define TAUT_INLINE
#define TAUT_ON_USE
#define TAUT_ON_USE_BODY
#else
#define TAUT_INLINE inline
#define TAUT_ON_USE template <class = void>
#define TAUT_ON_USE_BODY template <class>
#endif
