// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <taut/impl/core/compute/program/few_functions.hpp>
#include <taut/impl/core/symbolic/scalar_type.hpp>
#include <taut/recording.hpp>

namespace taut::impl
{

/// What a macro of a program stands for.
struct setting
{
    std::string_view macro;
    std::string value;

    setting(std::string_view name, std::string_view text) : macro(name), value(text) {}
    setting(std::string_view name, int number) : macro(name), value(std::to_string(number)) {}
    setting(std::string_view name, std::size_t number) : macro(name), value(std::to_string(number)) {}

    friend bool operator==(const setting&, const setting&) = default;
};

/// One launch of a kernel on the host device.
struct host_call
{
    const void* const* arguments; ///< where each one's value is: a number, or a pointer to memory
    std::size_t items;
    std::span<const kernel_text> parts; ///< of own_program
};

/// A kernel of kernels/*.cl as C++.
struct host_kernel
{
    std::string_view name;
    void (*run)(const host_call& call, std::size_t begin, std::size_t end); ///< of work-items begin .. end - 1
    std::size_t arguments;
    std::uint64_t memory; ///< a bit for each argument that is memory
    std::size_t grain;    ///< work-items that are worth another thread
};

/// A program in one of the forms that the host device has of it.
struct host_program
{
    std::vector<setting> settings; ///< of those that forms differ in
    std::vector<host_kernel> kernels;
};

/// One of taut's own programs (kernels/*.cl) in one of its forms. OpenCL devices compile its text with the settings as
/// macros; the host device looks them up among the forms that it was compiled with.
struct own_program
{
    std::string_view text; ///< lives as long as the process
    const std::vector<host_program>& (*host)();
    std::vector<setting> settings;
    scalar_type real = scalar_type::f32; ///< what its macro REAL stands for
    std::vector<kernel_text> parts = {}; ///< recorded functions that it calls, see part_form_for()

    /// Options of a compiler.
    std::string options() const
    {
        std::string all = few_functions;
        for (const setting& s : settings) all += "-D" + std::string(s.macro) + "=" + s.value + " ";
        return all;
    }
};

} // namespace taut::impl
