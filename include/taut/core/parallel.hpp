// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>

#include <taut/core/detail/crew.hpp>

namespace taut
{

/// Calls body(begin, end) for pieces that cover [0, n), on several threads, and returns when all are done. Pieces are
/// handed out as threads become free, so the body must not depend on how the range is cut.
///
/// threads: how many at most; 0: as many as the machine runs at once
/// grain:   smallest n that is worth another thread; below it the body runs once, on the calling thread
///
/// The first exception of a body is rethrown here; pieces not yet begun are then left out. Programs that call it link
/// with Threads::Threads.
template <class Body>
void parallel_for(std::size_t n, Body&& body, unsigned threads = 0, std::size_t grain = 1024)
{
    if (n == 0) return;
    static const unsigned at_once = std::max(1U, std::thread::hardware_concurrency()); // the answer is in a file
    if (threads == 0) threads = at_once;
    const std::size_t team = std::min<std::size_t>(threads, n / std::max<std::size_t>(grain, 1));
    if (team <= 1)
    {
        body(std::size_t{0}, n);
        return;
    }

    // A few pieces a thread even out a core that others use too.
    const std::size_t piece = std::max<std::size_t>(1, n / (8 * team));
    std::atomic<std::size_t> next{0};
    std::atomic<bool> failed{false};
    std::exception_ptr failure;
    auto work = [&]
    {
        try
        {
            for (std::size_t begin = next.fetch_add(piece); begin < n && !failed; begin = next.fetch_add(piece))
                body(begin, std::min(n, begin + piece));
        }
        catch (...)
        {
            if (!failed.exchange(true)) failure = std::current_exception();
        }
    };
    detail::crew::of_process().run(team - 1, work);
    if (failure) std::rethrow_exception(failure);
}

} // namespace taut
