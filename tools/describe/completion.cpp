// SPDX-License-Identifier: MIT
#include "describe/completion.hpp"

#include <algorithm>
#include <string_view>

namespace taut::tools
{

namespace
{

std::string made(const program_words& program)
{
    return "# SPDX-License-Identifier: MIT\n# Made by `" + program.own.name +
           " completion` of the program's own options.\n";
}

/// What functions of a shell are named after.
std::string identifier(const program_words& program)
{
    std::string name = '_' + program.own.name;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

std::string joined(const std::vector<std::string>& words, const std::string& between)
{
    std::string all;
    for (const auto& word : words) all += (all.empty() ? "" : between) + word;
    return all;
}

/// Text with something before each of some letters.
std::string escaped(const std::string& text, std::string_view letters, const std::string& with)
{
    std::string out;
    for (const char c : text) out += letters.find(c) == std::string_view::npos ? std::string(1, c) : with + c;
    return out;
}

/// Between single quotes, for bash and zsh.
std::string quoted(const std::string& text)
{
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
    return out + '\'';
}

std::vector<std::string> names_of(const command_words& command)
{
    std::vector<std::string> names;
    for (const auto& option : command.options) names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

// bash

/// The cases of the words before the one that is completed, of one command.
std::string bash_cases(const command_words& command, const std::string& function)
{
    std::string cases;
    for (const auto& option : command.options)
    {
        if (option.argument.empty()) continue;
        cases += "    " + command.name + ':' + joined(option.names, '|' + command.name + ':') + ")\n        ";
        if (!option.choices.empty())
            cases += function + "_words " + quoted(joined(option.choices, " "));
        else if (option.is_file)
            cases += function + "_files";
        else
            cases += "COMPREPLY=()";
        cases += "\n        return\n        ;;\n";
    }
    return cases;
}

// zsh

std::string zsh_option(const option_words& option)
{
    std::string value;
    if (!option.argument.empty())
    {
        value = ':' + escaped(option.argument, ":\\", "\\") + ':';
        if (!option.choices.empty())
            value += '(' + joined(option.choices, " ") + ')';
        else if (option.is_file)
            value += "_files";
        else
            value += ' ';
    }
    const std::string text = '[' + escaped(first_words(option.text), "[]:\\", "\\") + ']';
    std::string lines;
    for (const auto& name : option.names)
    {
        const std::string before = option.repeated ? "*" : '(' + joined(option.names, " ") + ')';
        const std::string equals = option.argument.empty() ? "" : name.starts_with("--") ? "=" : "+";
        lines += "            " + quoted(before + name + equals + text + value) + " \\\n";
    }
    return lines;
}

std::string zsh_command(const command_words& command)
{
    std::string text = "        " + command.name + ")\n            _arguments -s \\\n";
    for (const auto& option : command.options) text += "    " + zsh_option(option);
    int place = 0;
    for (const auto& option : command.positionals)
        text += "                " +
                quoted((option.repeated ? "*" : std::to_string(++place)) + ':' + option.argument + ":_files") + " \\\n";
    return text + "                && return 0\n            ;;\n";
}

// fish

std::string fish_quoted(const std::string& text)
{
    return '\'' + escaped(text, "'\\", "\\") + '\'';
}

std::string fish_option(const std::string& program, const std::string& condition, const option_words& option)
{
    std::string line = "complete -c " + program + " -n " + fish_quoted(condition);
    for (const auto& name : option.names)
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!option.argument.empty())
    {
        line += option.is_file ? " -r -F" : " -x";
        if (!option.choices.empty()) line += " -a " + fish_quoted(joined(option.choices, " "));
    }
    return line + " -d " + fish_quoted(first_words(option.text)) + '\n';
}

} // namespace

std::string bash_completion(const program_words& program)
{
    std::vector<std::string> commands;
    std::string options, values;
    const std::string function = identifier(program);
    for (const auto& command : program.commands)
    {
        commands.push_back(command.name);
        options += "    " + command.name + ") options=" + quoted(joined(names_of(command), " ")) + " ;;\n";
        values += bash_cases(command, function);
    }
    const std::string all = joined(commands, " ");
    return made(program) + "\n" + function + R"(_words() { mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current"); }

)" + function +
           R"(_files()
{
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
}

)" + function +
           R"(()
{
    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]} options
    COMPREPLY=()
    if ((COMP_CWORD == 1)); then
        )" +
           function + "_words " + quoted(all + ' ' + joined(names_of(program.own), " ")) + R"(
        return
    fi
    # --boundary=circle is three words
    if [[ $current == = ]]; then
        current=
    elif [[ $before == = ]]; then
        before=${COMP_WORDS[COMP_CWORD - 2]}
    fi
    case $command:$before in
)" + values +
           R"(    esac
    case $command in
)" + options +
           R"(    *) return ;;
    esac
    if [[ $current == -* ]]; then
        )" +
           function + R"(_words "$options"
    else
        )" +
           function + R"(_files
    fi
}

complete -F )" +
           function + ' ' + program.own.name + "\n";
}

std::string zsh_completion(const program_words& program)
{
    std::string named, commands;
    const std::string function = identifier(program);
    for (const auto& command : program.commands)
    {
        named += "        " + quoted(command.name + ':' + escaped(command.text, ":\\", "\\")) + '\n';
        commands += zsh_command(command);
    }
    std::string own;
    for (const auto& option : program.own.options) own += zsh_option(option);
    return "#compdef " + program.own.name + "\n" + made(program) + "\n" + function + R"(()
{
    local context state state_descr line
    typeset -A opt_args
    local -a commands=(
)" + named +
           R"(    )
    _arguments -C \
)" + own +
           R"(        '1:command:->command' \
        '*::argument:->argument' && return 0
    case $state in
    command) _describe command commands ;;
    argument)
        case ${words[1]} in
)" + commands +
           R"(        esac
        ;;
    esac
}

if [ "${funcstack[1]}" = )" +
           function + " ]; then " + function + R"( "$@"; else compdef )" + function + ' ' + program.own.name + "; fi\n";
}

std::string fish_completion(const program_words& program)
{
    const std::string& name = program.own.name;
    std::string text = made(program) + "complete -c " + name + " -f\n";
    for (const auto& option : program.own.options) text += fish_option(name, "__fish_use_subcommand", option);
    for (const auto& command : program.commands)
    {
        text += "\ncomplete -c " + name + " -n __fish_use_subcommand -a " + command.name + " -d " +
                fish_quoted(command.text) + '\n';
        const std::string condition = "__fish_seen_subcommand_from " + command.name;
        if (!command.positionals.empty()) text += "complete -c " + name + " -n " + fish_quoted(condition) + " -F\n";
        for (const auto& option : command.options) text += fish_option(name, condition, option);
    }
    return text;
}

} // namespace taut::tools
