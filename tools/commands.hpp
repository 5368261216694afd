// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <functional>
#include <vector>

#include <CLI/CLI.hpp>

#include "shared/exit_codes.hpp"
#include "shared/outputs.hpp"

namespace taut::tools
{

/// Body of a subcommand, called once its options are parsed and its files checked. Failures are exceptions; main()
/// knows their exit codes.
using command = std::function<exit_code(const outputs&)>;

/// Each adds one subcommand with its options and returns what it does. `launch` is when the program started.
command add_unwrap(CLI::App& program, std::chrono::steady_clock::time_point launch);
command add_atlas(CLI::App& program, std::chrono::steady_clock::time_point launch);
command add_bake(CLI::App& program, std::chrono::steady_clock::time_point launch);
command add_untangle(CLI::App& program, std::chrono::steady_clock::time_point launch);
command add_deform(CLI::App& program, std::chrono::steady_clock::time_point launch);
command add_smooth(CLI::App& program, std::chrono::steady_clock::time_point launch);
command add_paste(CLI::App& program, std::chrono::steady_clock::time_point launch);
command add_check(CLI::App& program);
command add_eval(CLI::App& program);
command add_view(CLI::App& program);
command add_batch(CLI::App& program, std::chrono::steady_clock::time_point launch);
command add_devices(CLI::App& program);
/// Hidden: of build_elsewhere().
command add_build_kernels(CLI::App& program);
/// Hidden: of packages, and of who sets up a shell.
command add_completion(CLI::App& program);
command add_man(CLI::App& program);

/// All of them, in the order in which the help lists them.
inline std::vector<command> add_commands(CLI::App& program, std::chrono::steady_clock::time_point launch)
{
    return {add_unwrap(program, launch),
            add_atlas(program, launch),
            add_bake(program, launch),
            add_untangle(program, launch),
            add_deform(program, launch),
            add_smooth(program, launch),
            add_paste(program, launch),
            add_check(program),
            add_eval(program),
            add_view(program),
            add_batch(program, launch),
            add_devices(program),
            add_build_kernels(program),
            add_completion(program),
            add_man(program)};
}

} // namespace taut::tools
