// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace taut::impl
{

/// Counts of what a queue has done since its construction: host waits dominate costs, then launches.
struct queue_counters
{
    std::uint64_t launches = 0;      ///< kernels enqueued
    std::uint64_t waits = 0;         ///< times the host blocked: reads, writes, finish
    std::uint64_t bytes_read = 0;    ///< device to host
    std::uint64_t bytes_written = 0; ///< host to device
    std::uint64_t builds = 0;        ///< programs compiled
    double build_seconds = 0;        ///< host seconds spent compiling them
};

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
