// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdlib>
#include <exception>
#include <string_view>
#include <thread>

#include <taut/impl/core/core/crew.hpp>
#include <taut/impl/core/core/parallel.hpp>

namespace taut::impl
{

unsigned threads_at_once()
{
    unsigned wished = 0;
    if (const char* wish = std::getenv("TAUT_THREADS"))
    {
        const std::string_view digits(wish);
        std::from_chars(digits.data(), digits.data() + digits.size(), wished);
    }
    return wished > 0 ? wished : std::max(1U, std::thread::hardware_concurrency());
}

void run_pieces(std::size_t n, void* body, void (*call)(void* body, std::size_t begin, std::size_t end),
                unsigned threads, std::size_t grain)
{
    if (n == 0) return;
    static const unsigned at_once = threads_at_once(); // the answer is in a file
    if (threads == 0) threads = at_once;
    const std::size_t team = std::min<std::size_t>(threads, n / std::max<std::size_t>(grain, 1));
    if (team <= 1) return call(body, 0, n);

    // A few pieces per thread even out a core that others use too.
    const std::size_t piece = std::max<std::size_t>(1, n / (8 * team));
    std::atomic<std::size_t> next{0};
    std::atomic<bool> failed{false};
    std::exception_ptr failure;
    auto work = [&]
    {
        try
        {
            for (std::size_t begin = next.fetch_add(piece); begin < n && !failed; begin = next.fetch_add(piece))
                call(body, begin, std::min(n, begin + piece));
        }
        catch (...)
        {
            if (!failed.exchange(true)) failure = std::current_exception();
        }
    };
    crew::of_process().run(team - 1, work);
    if (failure) std::rethrow_exception(failure);
}

} // namespace taut::impl
