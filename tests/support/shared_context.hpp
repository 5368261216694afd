// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/compute/queue.hpp>

namespace taut::test
{

/// The context of queues that need none of their own. PoCL reads its library of functions once a context, which takes
/// half a second.
inline cl_context shared_context()
{
    static const queue& first = *new queue; // not released at the end, when a driver may be gone already
    return first.native_context();
}

} // namespace taut::test
