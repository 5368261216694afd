// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <taut/impl/symbolic/scalar_type.hpp>

namespace taut::impl
{

/// Use of an argument by a kernel.
enum class argument_kind : std::uint8_t
{
    in,     ///< a pointer that is only read
    out,    ///< a pointer that is only written
    inout,  ///< a pointer that is read and written
    scalar, ///< a number, the same for all work-items
};

/// One argument of a kernel, in the order of clSetKernelArg.
struct kernel_argument
{
    std::string name;
    argument_kind kind{};
    scalar_type type{};

    friend bool operator==(const kernel_argument&, const kernel_argument&) = default;
};

/// Distribution of `count` indices along dimension 0 over the work-items of a kernel.
enum class kernel_form : std::uint8_t
{
    item,    ///< one index each: the global size is the count
    guarded, ///< one index each, and those beyond the count return: for GPUs, where the global size is rounded up
    run,     ///< run_length consecutive indices each, in a loop that vectorises: for CPUs, with local size 1
    part,    ///< no kernel but a function, for kernels written by hand: indices taut_first, taut_first + taut_step, ...
             ///< below taut_last, which are its last three arguments; the loop vectorises where the step is 1
};

/// Expected share of a kernel in the time of a run.
enum class kernel_use : std::uint8_t
{
    often,  ///< the device's compiler does its best
    seldom, ///< a few short launches a run: kernel_form::run is compiled without optimisations, as CPUs would wait
            ///< longer for the compiler than for the kernel
};

/// Indices per work-item of kernel_form::run: long enough to hide the cost of starting one.
inline constexpr idx run_length = 256;

/// A complete OpenCL C 1.2 program with one kernel, or the function of kernel_form::part. Equal recordings give equal
/// text, so the text is its own cache key.
struct kernel_text
{
    std::string name;
    std::string source;
    std::vector<kernel_argument> arguments; ///< guarded and run have a last one, the int `taut_count`; part has three
    kernel_form form = kernel_form::item;
    std::vector<std::size_t> by_index; ///< positions of arguments that are read or written at [i], the plain index
};

} // namespace taut::impl
