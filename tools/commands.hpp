// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <functional>
#include <vector>

#include "shared/exit_codes.hpp"
#include "shared/outputs.hpp"

namespace taut::tools
{

/// Body of a subcommand, called once its options are parsed and its files checked. Failures are exceptions; main()
/// knows their exit codes.
using command = std::function<exit_code(const outputs&)>;

/// Each adds one subcommand with its options and returns what it does. `launch` is when the program started.
command add_unwrap(command_line& program, std::chrono::steady_clock::time_point launch);
command add_atlas(command_line& program, std::chrono::steady_clock::time_point launch);
command add_bake(command_line& program, std::chrono::steady_clock::time_point launch);
command add_untangle(command_line& program, std::chrono::steady_clock::time_point launch);
command add_deform(command_line& program, std::chrono::steady_clock::time_point launch);
command add_smooth(command_line& program, std::chrono::steady_clock::time_point launch);
command add_paste(command_line& program, std::chrono::steady_clock::time_point launch);
command add_check(command_line& program);
command add_eval(command_line& program);
command add_view(command_line& program);
command add_batch(command_line& program, std::chrono::steady_clock::time_point launch);
command add_devices(command_line& program);
/// Hidden: of build_elsewhere().
command add_build_kernels(command_line& program);
/// Hidden: of packages, and of who sets up a shell.
command add_completion(command_line& program);
command add_man(command_line& program);

/// All of them, in the order in which the help lists them.
inline std::vector<command> add_commands(command_line& program, std::chrono::steady_clock::time_point launch)
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
