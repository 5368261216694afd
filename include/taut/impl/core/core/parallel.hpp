// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace taut::impl
{

/// parallel_for with the body behind a pointer, so that it is compiled once.
void run_pieces(std::size_t n, void* body, void (*call)(void* body, std::size_t begin, std::size_t end),
                unsigned threads, std::size_t grain);

/// Calls body(begin, end) for pieces that cover [0, n), on several threads, and returns when all are done. Pieces are
/// handed out as threads become free, so the body must not depend on how the range is cut.
///
/// threads: maximum number; 0: as many as $TAUT_THREADS says, or the machine runs at once
/// grain:   smallest n that is worth another thread; below it the body runs once, on the calling thread
///
/// The first exception of a body is rethrown here; pieces not yet begun are then left out. Programs that call it link
/// with Threads::Threads.
template <class Body>
void parallel_for(std::size_t n, Body&& body, unsigned threads = 0, std::size_t grain = 1024)
{
    using callable = std::remove_reference_t<Body>;
    impl::run_pieces(
        n, const_cast<void*>(static_cast<const void*>(std::addressof(body))),
        [](void* f, std::size_t begin, std::size_t end) { (*static_cast<callable*>(f))(begin, end); }, threads, grain);
}

} // namespace taut::impl
