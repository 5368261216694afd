// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

namespace taut
{

/// Begins to build a program in another process, into the driver's cache, and returns what asks for its end: waits a
/// moment and says whether there is use in waiting on. Empty functions: nobody builds it.
using program_builder = std::function<std::function<bool()>(const std::string& source, const std::string& options)>;

} // namespace taut
