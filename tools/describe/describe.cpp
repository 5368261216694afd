// SPDX-License-Identifier: MIT
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include "commands.hpp"
#include "describe/completion.hpp"
#include "describe/man_page.hpp"
#include "describe/program_words.hpp"
#include "shared/choices.hpp"
#include "shared/command_line.hpp"
#include "shared/failure.hpp"
#include "shared/writing.hpp"

namespace taut::tools
{

namespace
{

enum class shell
{
    bash,
    zsh,
    fish
};

std::string completion_of(shell kind, const program_words& program)
{
    switch (kind)
    {
    case shell::zsh:
        return zsh_completion(program);
    case shell::fish:
        return fish_completion(program);
    default:
        return bash_completion(program);
    }
}

exit_code write_man_pages(const program_words& program, const std::filesystem::path& folder)
{
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure) throw output_error(folder.string() + ": " + failure.message());
    const std::string& name = program.own.name;
    writing(
        [&]
        {
            io::write_file(folder / (name + ".1"), man_page(program));
            for (const auto& command : program.commands)
                io::write_file(folder / (name + '-' + command.name + ".1"), man_page(program, command));
        });
    return exit_code::valid;
}

} // namespace

command add_completion(command_line& program)
{
    const auto kind = std::make_shared<shell>();
    const auto app = program.add_subcommand("completion", "Print a completion script for a shell");
    app.hide();
    add_choice<shell>(app, "SHELL", *kind, {{"bash", shell::bash}, {"zsh", shell::zsh}, {"fish", shell::fish}},
                      "The shell")
        .required();
    return [kind, &program](const outputs&)
    {
        write_standard_output(completion_of(*kind, describe(program)));
        return exit_code::valid;
    };
}

command add_man(command_line& program)
{
    const auto folder = std::make_shared<std::string>();
    const auto app = program.add_subcommand("man", "Write man pages, one per command");
    app.hide();
    app.add_option("FOLDER", *folder, "Folder to write; created if missing").required();
    return [folder, &program](const outputs&) { return write_man_pages(describe(program), *folder); };
}

} // namespace taut::tools
