// SPDX-License-Identifier: MIT
#include "job_files.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <string_view>

#include <CLI/CLI.hpp>

#include "../commands.hpp"
#include "../outputs.hpp"

namespace taut::tools::batch
{

struct argument_reader::program
{
    CLI::App app;
    std::vector<command> commands; // they own what options are written to
};

argument_reader::argument_reader() : program_(std::make_unique<program>())
{
    program_->app.require_subcommand(1);
    program_->commands = add_commands(program_->app, std::chrono::steady_clock::now());
}

argument_reader::~argument_reader() = default;

job_files argument_reader::files(const std::vector<std::string>& args)
{
    constexpr std::array<std::string_view, 5> written = {"output", "stats", "picture", "render", "report"};
    job_files found;
    try
    {
        program_->app.parse(std::vector<std::string>(args.rbegin(), args.rend()));
    }
    catch (const CLI::Error&) // --help is one, too
    {
        return found;
    }
    for (const auto* command : program_->app.get_subcommands())
        for (const auto* option : command->get_options())
        {
            const auto& names = option->get_lnames();
            const bool output = std::any_of(names.begin(), names.end(),
                                            [&](const std::string& name) {
                                                return std::find(written.begin(), written.end(), name) != written.end();
                                            });
            if (!output && !option->get_type_name().starts_with("FILE")) continue;
            for (const auto& path : option->results())
            {
                if (path != standard_input && path != standard_output)
                    (output ? found.outputs : found.inputs).push_back(path);
                if (option->check_lname("stats")) found.stats = path;
            }
        }
    return found;
}

} // namespace taut::tools::batch
