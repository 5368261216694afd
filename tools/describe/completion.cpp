// SPDX-License-Identifier: MIT
#include "describe/completion.hpp"

#include <string_view>

namespace taut::tools
{

namespace
{

constexpr const char* made =
    "# SPDX-License-Identifier: MIT\n# Made by `taut completion` of the program's own options.\n";

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
std::string bash_cases(const command_words& command)
{
    std::string cases;
    for (const auto& option : command.options)
    {
        if (option.argument.empty()) continue;
        cases += "    " + command.name + ':' + joined(option.names, '|' + command.name + ':') + ")\n        ";
        if (!option.choices.empty())
            cases += "_taut_words " + quoted(joined(option.choices, " "));
        else if (option.is_file)
            cases += "_taut_files";
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

std::string fish_option(const std::string& condition, const option_words& option)
{
    std::string line = "complete -c taut -n " + fish_quoted(condition);
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
    for (const auto& command : program.commands)
    {
        commands.push_back(command.name);
        options += "    " + command.name + ") options=" + quoted(joined(names_of(command), " ")) + " ;;\n";
        values += bash_cases(command);
    }
    const std::string all = joined(commands, " ");
    return std::string(made) + R"(
_taut_words() { mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current"); }

_taut_files()
{
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
}

_taut()
{
    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]} options
    COMPREPLY=()
    if ((COMP_CWORD == 1)); then
        _taut_words )" +
           quoted(all + ' ' + joined(names_of(program.own), " ")) + R"(
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
        _taut_words "$options"
    else
        _taut_files
    fi
}

complete -F _taut taut
)";
}

std::string zsh_completion(const program_words& program)
{
    std::string named, commands;
    for (const auto& command : program.commands)
    {
        named += "        " + quoted(command.name + ':' + escaped(command.text, ":\\", "\\")) + '\n';
        commands += zsh_command(command);
    }
    std::string own;
    for (const auto& option : program.own.options) own += zsh_option(option);
    return std::string("#compdef taut\n") + made + R"(
_taut()
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

if [ "${funcstack[1]}" = _taut ]; then _taut "$@"; else compdef _taut taut; fi
)";
}

std::string fish_completion(const program_words& program)
{
    std::string text = std::string(made) + "complete -c taut -f\n";
    for (const auto& option : program.own.options) text += fish_option("__fish_use_subcommand", option);
    for (const auto& command : program.commands)
    {
        text += "\ncomplete -c taut -n __fish_use_subcommand -a " + command.name + " -d " + fish_quoted(command.text) +
                '\n';
        const std::string condition = "__fish_seen_subcommand_from " + command.name;
        if (!command.positionals.empty()) text += "complete -c taut -n " + fish_quoted(condition) + " -F\n";
        for (const auto& option : command.options) text += fish_option(condition, option);
    }
    return text;
}

} // namespace taut::tools
