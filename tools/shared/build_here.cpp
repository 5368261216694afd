// SPDX-License-Identifier: MIT
#include "shared/build_elsewhere.hpp"
#include "shared/own_kernels.hpp"

namespace taut::tools
{

/// None: without child processes this one builds its kernels.
queue_options::builder build_elsewhere(const taut::device&, const std::string&)
{
    return {};
}

/// Nothing is required: on Windows a driver keeps its kernels in the user's profile.
void require_own_kernels(const taut::device&) {}

} // namespace taut::tools
