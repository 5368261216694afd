// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <taut/impl/core/compute/host/row_launch.hpp>
#include <taut/impl/core/compute/program/own_program.hpp>

// 1: programs are compiled once more, with AVX2, for machines that have it, as in taut::taut. Programs that compile the
// bodies themselves choose by the compiler's flags (-march), and save its time.
#ifndef TAUT_HOST_AVX2
#define TAUT_HOST_AVX2 0
#endif

namespace taut::impl
{

/// Memory of a thread for one work-item, to be used by one kernel at a time.
inline void* host_scratch(std::size_t bytes)
{
    static thread_local struct
    {
        std::unique_ptr<std::byte[]> memory;
        std::size_t size = 0;
    } mine;
    constexpr std::size_t line = 128;
    std::size_t room = bytes + line;
    if (mine.size < room)
    {
        mine.memory = std::make_unique<std::byte[]>(room);
        mine.size = room;
    }
    void* first = mine.memory.get();
    return std::align(line, bytes, first, room);
}

} // namespace taut::impl

#include <taut/impl/core/compute/host/baseline_begin.inl>
#if defined(__AVX512F__)
inline constexpr int machine_bytes = 64;
#elif defined(__AVX__)
inline constexpr int machine_bytes = 32;
#else
inline constexpr int machine_bytes = 16; // SSE2, NEON, simd128
#endif
#include <taut/impl/core/compute/host/opencl_c.inl>

#include <taut/impl/core/compute/host/baseline_end.inl>

#if TAUT_HOST_AVX2
#include <taut/impl/core/compute/host/avx2_begin.inl>
inline constexpr int machine_bytes = 32;
#include <taut/impl/core/compute/host/opencl_c.inl>

#include <taut/impl/core/compute/host/avx2_end.inl>

/// A function of the best set that this machine has.
#define TAUT_HOST_SET(name)                                                                                            \
    (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? host_avx2::name : host_baseline::name)
#else
#define TAUT_HOST_SET(name) (host_baseline::name)
#endif
