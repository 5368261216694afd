// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <thread>

namespace taut::impl
{

/// Number of threads: $TAUT_THREADS, or as many as the machine runs at once.
unsigned threads_at_once();

/// Threads that help callers of parallel_for, kept between calls: starting one costs as much as a small piece of work.
/// They look for work for a moment before they sleep, and yield to other threads.
class crew
{
public:
    /// Crew of the process. Never destroyed: helpers may be asleep in it when the program ends.
    static crew& of_process()
    {
        static crew& one = *new crew;
        return one;
    }

    /// Calls job() on this thread and, as they come, on up to `helpers` others; returns when all of these are done. A
    /// caller that finds the crew busy, as a job that calls this, works alone. The job must not throw.
    template <class Job>
    void run(std::size_t helpers, Job& job)
    {
        if (in_use_.test_and_set(std::memory_order_acquire))
        {
            job();
            return;
        }
        hire(helpers);
        call_ = [](void* j) { (*static_cast<Job*>(j))(); };
        job_ = &job;
        places_.store(std::min(helpers, hired_), std::memory_order_release);
        calls_.fetch_add(1);
        calls_.notify_all();
        job();
        // Nobody is waited for who has not come yet.
        std::uint64_t places = places_.load();
        while (!places_.compare_exchange_weak(places, places & ~open_places))
        {
        }
        while (places_.load(std::memory_order_acquire) != 0) std::this_thread::yield();
        in_use_.clear(std::memory_order_release);
    }

private:
    crew() = default;

    void hire(std::size_t helpers)
    {
        try
        {
            for (; hired_ < helpers; ++hired_) std::thread(&crew::help, this).detach();
        }
        catch (const std::exception&)
        {
            // No more threads to be had: those that run share the work.
        }
    }

    [[noreturn]] void help()
    {
        for (std::uint32_t seen = 0;; seen = calls_.load())
        {
            await_call(seen);
            std::uint64_t places = places_.load();
            while ((places & open_places) != 0)
                if (places_.compare_exchange_weak(places, places - 1 + one_at_work, std::memory_order_acquire))
                {
                    call_(job_);
                    places_.fetch_sub(one_at_work, std::memory_order_release);
                    break;
                }
        }
    }

    void await_call(std::uint32_t seen)
    {
        using clock = std::chrono::steady_clock;
        for (const auto end = clock::now() + std::chrono::microseconds(100); clock::now() < end;)
        {
            if (calls_.load() != seen) return;
            std::this_thread::yield();
        }
        calls_.wait(seen);
    }

    static constexpr std::uint64_t one_at_work = std::uint64_t{1} << 32U, open_places = one_at_work - 1;

    std::atomic_flag in_use_; // not a mutex: a job that calls run() asks for it on the thread that holds it
    std::size_t hired_ = 0;
    void (*call_)(void*) = nullptr;
    void* job_ = nullptr;
    std::atomic<std::uint64_t> places_{0}; // low half: open for who comes; high half: taken and at work
    std::atomic<std::uint32_t> calls_{0};
};

} // namespace taut::impl
