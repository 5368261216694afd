// SPDX-License-Identifier: MIT
#pragma once

#include <taut/options.hpp>

namespace taut::impl
{

/// Counts of a queue since `before`.
inline queue_counters counted_since(const queue_counters& before, queue_counters now)
{
    now.launches -= before.launches;
    now.waits -= before.waits;
    now.bytes_read -= before.bytes_read;
    now.bytes_written -= before.bytes_written;
    now.builds -= before.builds;
    now.build_seconds -= before.build_seconds;
    return now;
}

} // namespace taut::impl
