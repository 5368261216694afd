// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/files/file/plain_file.hpp>
#include <taut/impl/files/file/posix_file.hpp>

namespace taut::io::impl
{

#if defined(__unix__) || defined(__APPLE__)
using new_file = posix_file;
#else
using new_file = plain_file;

/// Does nothing: there is no signal handler on systems without POSIX.
inline void remove_temporaries() noexcept {}
#endif

} // namespace taut::io::impl
