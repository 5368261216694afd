// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <taut/impl/core/symbolic/device_functions.hpp>
#include <taut/impl/core/symbolic/statement_writer.hpp>

namespace taut::impl
{

/// Indices per work-item of kernel_form::run: long enough to hide the cost of starting one.
inline constexpr idx run_length = 256;

/// The declaration of one argument. No `restrict`: the loop of kernel_form::run asserts independence by itself.
std::string parameter_text(const kernel_argument& a);

/// Returns whether the statements stand in a loop over indices.
inline bool has_loop(kernel_form form)
{
    return form == kernel_form::run || form == kernel_form::part;
}

/// The lines before the statements: which indices this work-item has.
std::string prologue(kernel_form form, const kernel_needs& needs);

/// The positions of the arguments that are read or written at the global id along dimension 0 itself.
std::vector<std::size_t> accessed_by_index(const graph& t, const schedule& plan);

/// The OpenCL C 1.2 program with one kernel that performs the stores of a tape, and only what they need. Equal
/// recordings give equal text. It mentions `double` only if it computes with it or has an argument of that type, so
/// that a float kernel builds on devices without fp64. Throws tape_error for a free variable and for a value that left
/// its loop.
kernel_text emit(const graph& t, std::string name, std::vector<kernel_argument> arguments,
                 kernel_form form = kernel_form::item, kernel_use use = kernel_use::often);

} // namespace taut::impl
