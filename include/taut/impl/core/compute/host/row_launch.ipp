// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <tuple>
#include <type_traits>
#include <utility>

#include <taut/impl/core/compute/host/row_launch.hpp>
#include <taut/impl/core/symbolic/apply.hpp>

namespace taut::impl
{

/// What operations run on: a block of indices.
struct row_frame
{
    char* const* rows;
    char* const* memory;           ///< of arguments
    const std::uint64_t* uniforms; ///< bits
    const row_operations::handler* table;
    std::ptrdiff_t first, step; ///< the first index, and the distance to the next one
    std::ptrdiff_t n, padded;   ///< indices, and places of rows in use: those beyond n have the last index again
};

/// Runs operations; `ahead` more must follow them. An address that is loaded two operations ahead is there when the
/// jump to it is foretold wrong, as most are in long programs: the processor then corrects itself while vectors are
/// computed.
inline void run_rows(const row_operation* at, const row_operation* end, const row_frame& f)
{
    const row_operation* next = at + 1 + at->body;
    auto handler = f.table[at->code], following = f.table[next->code];
    while (at != end)
    {
        const row_operation* const third = next + 1 + next->body;
        const auto later = f.table[third->code];
        handler(*at, f);
        at = std::exchange(next, third);
        handler = std::exchange(following, later);
    }
}

} // namespace taut::impl

#define TAUT_INLINE __attribute__((always_inline)) inline

// The same operations in one program for each instruction set, whatever it is compiled for.
#ifdef __GNUC__
namespace taut::impl::rows_of_all_machines
{
constexpr int bytes = 16;
#include <taut/impl/core/compute/host/operations.inl>
#include <taut/impl/core/compute/host/operations_table.inl>
} // namespace taut::impl::rows_of_all_machines
#endif

// Not on Windows, which keeps stacks at 16 bytes: spilled vectors of more would not be aligned.
#if defined(__x86_64__) && !defined(_WIN32)
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2,fma"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,fma")
#endif
namespace taut::impl::rows_of_avx2
{
constexpr int bytes = 32;
#include <taut/impl/core/compute/host/operations.inl>
#include <taut/impl/core/compute/host/operations_table.inl>
} // namespace taut::impl::rows_of_avx2
#ifdef __clang__
#pragma clang attribute pop
#pragma clang attribute push(__attribute__((target("avx512f,avx512dq,avx512vl,fma"))), apply_to = function)
#else
#pragma GCC target("avx512f,avx512dq,avx512vl,fma")
#endif
namespace taut::impl::rows_of_avx512
{
constexpr int bytes = 64;
#include <taut/impl/core/compute/host/operations.inl>
#include <taut/impl/core/compute/host/operations_table.inl>
} // namespace taut::impl::rows_of_avx512
#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

#undef TAUT_INLINE

namespace taut::impl
{

std::span<const row_operations> row_operation_sets()
{
    static constexpr row_operations sets[] = {
#if defined(__x86_64__) && !defined(_WIN32)
        {"avx512", rows_of_avx512::table.all.data()},
        {"avx2", rows_of_avx2::table.all.data()},
#endif
        {"all machines", rows_of_all_machines::table.all.data()}
    };
    std::span<const row_operations> known = sets;
#if defined(__x86_64__) && !defined(_WIN32)
    const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                        __builtin_cpu_supports("avx512vl");
    known = known.subspan(avx512 ? 0 : avx2 ? 1 : 2);
#endif
    return known;
}

namespace rows
{

/// Indices of a block: its rows stay in the first-level cache.
constexpr std::ptrdiff_t block = 128;

/// Places of a row in use: operations do up to 64 at a time.
constexpr std::ptrdiff_t whole(std::ptrdiff_t n)
{
    return (n + 63) / 64 * 64;
}

inline std::uint64_t read(const char* from, std::size_t bytes)
{
    std::uint32_t low = 0;
    std::uint64_t bits = 0;
    if (bytes == sizeof bits)
        std::memcpy(&bits, from, sizeof bits);
    else
        std::memcpy(&low, from, sizeof low), bits = low;
    return bits;
}

} // namespace rows

row_launch::row_launch(const row_program& program, std::span<const host_argument> arguments,
                       const row_operations& operations)
    : program_(program), operations_(operations), uniforms_(program.values)
{
    for (const host_argument& a : arguments) memory_.push_back(a.memory);
    const auto value = [&](node_id k) { return k == no_node ? 0 : uniforms_[static_cast<std::size_t>(k)]; };
    for (const auto& u : program.uniforms)
    {
        const node& x = u.what;
        std::uint64_t& to = uniforms_[static_cast<std::size_t>(u.to)];
        if (x.op == opcode::argument)
            to = arguments[x.payload].bits;
        else if (x.op == opcode::load)
            to = rows::read(memory_[x.payload] + std::ptrdiff_t{from_bits<idx>(value(x.operands[0]))} *
                                                     static_cast<std::ptrdiff_t>(size_of(x.type)),
                            size_of(x.type));
        else // nothing for an integer without a result, as on a device
            to = apply(x, u.from, value(x.operands[0]), value(x.operands[1]), value(x.operands[2])).value_or(0);
    }
    // What is written at one place twice is written in the order of the stores.
    const auto place = [&](const row_program::alias& a)
    { return std::pair(a.argument, uniforms_[static_cast<std::size_t>(a.offset)]); };
    for (const auto& a : program.aliases)
        for (const auto& b : program.aliases)
            if (&a < &b && a.store != no_node && b.store != no_node && place(a) == place(b)) in_place_ = false;
}

char* row_launch::place(const row_program::alias& a, std::ptrdiff_t index) const
{
    const idx offset = from_bits<idx>(uniforms_[static_cast<std::size_t>(a.offset)]);
    return memory_[a.argument] + (index + offset) * program_.widths[static_cast<std::size_t>(a.row)];
}

void row_launch::fill_splats(std::span<char* const> own, std::ptrdiff_t length) const
{
    for (const auto& s : program_.splats)
    {
        const std::uint64_t bits = uniforms_[static_cast<std::size_t>(s.uniform)];
        const auto low = static_cast<std::uint32_t>(s.type == scalar_type::boolean ? 0 - bits : bits);
        char* const to = own[static_cast<std::size_t>(s.row)];
        for (std::ptrdiff_t i = 0; i < length; ++i)
            if (s.type == scalar_type::f64)
                std::memcpy(to + 8 * i, &bits, 8);
            else
                std::memcpy(to + 4 * i, &low, 4);
    }
}

void row_launch::copy_in(const row_program::alias& a, char* own, const row_frame& f) const
{
    const auto width = static_cast<std::size_t>(program_.widths[static_cast<std::size_t>(a.row)]);
    for (std::ptrdiff_t i = 0; i < f.padded; ++i, own += width)
        std::memcpy(own, place(a, f.first + f.step * std::min(i, f.n - 1)), width);
}

void row_launch::copy_out(const row_program::alias& a, const char* own, const row_frame& f) const
{
    const auto width = static_cast<std::size_t>(program_.widths[static_cast<std::size_t>(a.row)]);
    for (std::ptrdiff_t i = 0; i < f.n; ++i, own += width) std::memcpy(place(a, f.first + f.step * i), own, width);
}

void row_launch::run(idx first, idx last, idx step) const
{
    if (first >= last) return;
    using namespace rows;
    const std::ptrdiff_t count = (std::ptrdiff_t{last} - first - 1) / step + 1;
    const std::ptrdiff_t length = std::min(block, whole(count));
    // Rows are no power of two apart, so that they share no lines of the cache.
    std::ptrdiff_t size = 64;
    for (const std::ptrdiff_t width : program_.widths) size += length * width + 64;
    const std::unique_ptr<char[]> scratch(new char[static_cast<std::size_t>(size)]);
    std::vector<char*> own;
    char* at = scratch.get() + 64 - reinterpret_cast<std::uintptr_t>(scratch.get()) % 64;
    for (const std::ptrdiff_t width : program_.widths) own.push_back(std::exchange(at, at + length * width + 64));
    fill_splats(own, length);

    std::vector<char*> all = own;
    row_frame f{all.data(), memory_.data(), uniforms_.data(), operations_.table, first, step, 0, 0};
    for (std::ptrdiff_t done = 0; done < count; done += block)
    {
        f.first = first + done * step;
        f.n = std::min(block, count - done);
        f.padded = whole(f.n);
        const bool direct = in_place_ && step == 1 && f.n == f.padded;
        for (const auto& a : program_.aliases)
        {
            const auto r = static_cast<std::size_t>(a.row);
            all[r] = direct ? place(a, f.first) : own[r];
            if (!direct && a.store == no_node) copy_in(a, own[r], f);
        }
        run_rows(program_.code.data(), program_.code.data() + program_.code.size() - row_program::ahead, f);
        if (direct) continue;
        for (const auto& a : program_.aliases)
            if (a.store != no_node) copy_out(a, own[static_cast<std::size_t>(a.row)], f);
    }
}

} // namespace taut::impl
