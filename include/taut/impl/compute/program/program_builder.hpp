// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace taut::impl
{

/// Waits a moment for what another process compiles, and says whether there is use in waiting on. Empty: for nobody.
using build_under_way = std::function<bool()>;

/// Begins to compile a program in another process, into the driver's cache. kernels: those of them that are wanted, of
/// a program that this process has built and that the cache so holds; none: the whole of one that is not built yet.
using program_builder = std::function<build_under_way(const std::string& source, const std::string& options,
                                                      const std::vector<std::string>& kernels)>;

} // namespace taut::impl
