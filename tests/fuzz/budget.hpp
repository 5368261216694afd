// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include <sanitizer/allocator_interface.h>

#include "require.hpp"

namespace taut::fuzz
{

/// What an input may cost, in proportion to its bytes: memory at once, and bytes asked for one after the other, which
/// count the work of who copies again and again, the same on every machine; and processor time, some hundred times what
/// a reader takes under sanitizers, so that only what grows with a square is beyond it. Ends the fuzzer where it was
/// more.
class budget
{
public:
    explicit budget(std::size_t size) : size_(static_cast<std::ptrdiff_t>(size))
    {
        static const bool counting = __sanitizer_install_malloc_and_free_hooks(&allocated, &freed) != 0;
        require(counting, "the sanitizer counts memory");
        live_ = most_ = asked_ = 0;
        begun_ = std::clock();
    }
    ~budget()
    {
        const double seconds = static_cast<double>(std::clock() - begun_) / CLOCKS_PER_SEC;
        if (seconds > 4 + 5e-5 * static_cast<double>(size_))
        {
            std::fprintf(stderr, "%g s of a processor for %td bytes of input\n", seconds, size_);
            require(false, "time in proportion to the input");
        }
        if (most_ <= free_of_charge + at_once * size_ && asked_ <= free_of_charge + together * size_) return;
        std::fprintf(stderr, "%td bytes at once and %td together for %td bytes of input\n", most_.load(), asked_.load(),
                     size_);
        require(false, "memory in proportion to the input");
    }
    budget(const budget&) = delete;
    budget& operator=(const budget&) = delete;

private:
    static constexpr std::ptrdiff_t free_of_charge = 1 << 20, at_once = 1500, together = 15000;

    static void allocated(const volatile void*, std::size_t size)
    {
        const auto n = static_cast<std::ptrdiff_t>(size);
        asked_ += n;
        const std::ptrdiff_t now = live_ += n;
        for (std::ptrdiff_t most = most_; now > most && !most_.compare_exchange_weak(most, now);)
        {
        }
    }
    static void freed(const volatile void* block)
    {
        live_ -= static_cast<std::ptrdiff_t>(__sanitizer_get_allocated_size(block));
    }

    std::ptrdiff_t size_;
    std::clock_t begun_ = 0;
    static inline std::atomic<std::ptrdiff_t> live_{0}, most_{0}, asked_{0};
};

} // namespace taut::fuzz
