// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>

namespace taut::impl
{

/// The line numbers that a compiler's log names, as in "file.cl:12:3: error: ...".
std::set<int> lines_named(const std::string& log);

/// The source around the lines that the log names, two before and after, numbered as the compiler numbers them (a
/// #line directive restarts the count). Without any such line, the beginning of the source.
std::string build_excerpt(const std::string& source, const std::string& log);

} // namespace taut::impl
