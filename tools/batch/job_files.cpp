// SPDX-License-Identifier: MIT
#include "batch/job_files.hpp"

#include <chrono>

#include "commands.hpp"
#include "shared/command_line.hpp"
#include "shared/tile_names.hpp"

namespace taut::tools::batch
{

struct argument_reader::program
{
    command_line app;
    std::vector<command> commands; // they own what options are written to
};

argument_reader::argument_reader() : program_(std::make_unique<program>())
{
    program_->commands = add_commands(program_->app, std::chrono::steady_clock::now());
}

argument_reader::~argument_reader() = default;

job_files argument_reader::files(const std::vector<std::string>& args)
{
    job_files found;
    if (!program_->app.accepts(args)) return found;
    for (const auto& command : program_->app.subcommands())
    {
        if (!command.parsed()) continue;
        for (const auto& file : files_of(command))
        {
            const auto path = file.path.string();
            if (file.option.name() == "--stats") found.stats = path;
            if (path != standard_input && path != standard_output)
                (file.is_read() ? found.inputs : found.outputs).push_back(path);
            if (!file.is_read() && file.use->tiles && names_tiles(path)) found.tiles.push_back(path);
        }
    }
    return found;
}

} // namespace taut::tools::batch
