// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace taut::tools
{

/// Largest resident size of this process so far, in bytes. A CPU device's buffers are part of it, a GPU's are not.
std::uint64_t peak_memory() noexcept;

} // namespace taut::tools
