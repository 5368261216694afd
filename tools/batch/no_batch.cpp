// SPDX-License-Identifier: MIT
#include "commands.hpp"
#include "shared/failure.hpp"

namespace taut::tools
{

command add_batch(command_line& program, std::chrono::steady_clock::time_point)
{
    const auto app = program.add_subcommand("batch", "Not on Windows: run many jobs, as processes with limits");
    app.prefix_command();
    return [](const outputs&) -> exit_code
    {
        throw usage_error("`taut batch` starts processes in the way of POSIX, and has no form for Windows; run `taut` "
                          "once for each job");
    };
}

} // namespace taut::tools
