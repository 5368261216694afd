// SPDX-License-Identifier: MIT
#pragma once

#include <taut/queue.hpp>

namespace taut::test
{

/// A queue for tests that need no context of their own: of OpenCL's devices in one that they share, as PoCL reads its
/// library of functions once a context, which takes half a second.
inline queue shared_context()
{
    static const queue& first = *new queue; // not released at the end, when a driver may be gone already
    return first.device().is_host() ? queue(first.device()) : queue(first.native_context());
}

} // namespace taut::test
