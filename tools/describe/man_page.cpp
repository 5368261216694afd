// SPDX-License-Identifier: MIT
#include "describe/man_page.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <sstream>

#include <taut/version.hpp>

namespace taut::tools
{

namespace
{

/// Text as it stands, whatever it holds.
std::string plain(const std::string& text)
{
    std::string out;
    for (const char c : text) out += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
    if (out.starts_with('.') || out.starts_with('\'')) out.insert(0, "\\&");
    return out;
}

std::string bold(const std::string& text)
{
    return "\\fB" + plain(text) + "\\fP";
}

std::string slanted(const std::string& text)
{
    return "\\fI" + plain(text) + "\\fP";
}

std::string header(const std::string& program, const std::string& name, const std::string& text)
{
    std::string upper = name;
    std::transform(upper.begin(), upper.end(), upper.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return ".\\\" Made by `" + program + " man` of the program's own options.\n.TH " + plain(upper) +
           " 1 \"\" \"taut " TAUT_VERSION_STRING "\" \"User Commands\"\n.SH NAME\n" + plain(name) + " \\- " +
           plain(text) + '\n';
}

/// -o OUT.obj, --output OUT.obj, or the name of a positional argument.
std::string heading(const option_words& option)
{
    if (option.names.empty()) return slanted(option.argument);
    std::string line;
    for (const auto& name : option.names)
        line +=
            (line.empty() ? "" : ", ") + bold(name) + (option.argument.empty() ? "" : ' ' + slanted(option.argument));
    return line;
}

std::string item(const option_words& option)
{
    std::string text = plain(option.text);
    if (!text.empty() && !text.ends_with('.')) text += '.';
    if (option.required && !option.names.empty()) text += " Required.";
    if (option.repeated && !option.names.empty()) text += " May be given more than once.";
    if (!option.range.empty()) text += " In " + plain(option.range) + '.';
    for (const auto& other : option.needs) text += " Needs " + bold(other) + '.';
    if (!option.usual.empty()) text += " Default: " + plain(option.usual) + '.';
    return ".TP\n" + heading(option) + '\n' + text + '\n';
}

/// "exit codes: 0 valid map; 2 usage", an entry a code.
std::string exit_status(const std::string& footer)
{
    constexpr std::string_view begin = "exit codes: ";
    if (!footer.starts_with(begin)) return footer.empty() ? "" : ".SH NOTES\n" + plain(footer) + '\n';
    std::istringstream parts(footer.substr(begin.size()));
    std::string out = ".SH EXIT STATUS\n";
    for (std::string part; std::getline(parts, part, ';');)
    {
        std::istringstream words(part);
        std::string entry;
        for (std::string word; words >> word;) entry += (entry.empty() ? "" : " ") + word;
        const std::size_t numbers = std::min(entry.find_first_not_of("0123456789, "), entry.size());
        const bool has_code = numbers > 0 && std::isdigit(static_cast<unsigned char>(entry[0]));
        if (has_code)
            out += ".TP\n" + bold(entry.substr(0, entry.find_last_of("0123456789", numbers - 1) + 1)) + '\n' +
                   plain(entry.substr(numbers)) + '\n';
        else
            out += plain(entry) + '\n';
    }
    return out;
}

std::string section(const std::string& title, const std::vector<option_words>& options)
{
    std::string out;
    for (const auto& option : options) out += item(option);
    return out.empty() ? out : ".SH " + title + '\n' + out;
}

} // namespace

std::string man_page(const program_words& program)
{
    const auto& own = program.own;
    std::string text = own.text; // the names of pages stand in lists, without a full stop
    if (text.ends_with('.')) text.pop_back();
    std::string page = header(own.name, own.name, text);
    page += ".SH SYNOPSIS\n" + bold(own.name) + ' ' + slanted("COMMAND") + " [" + slanted("OPTION") + "...] " +
            slanted("FILE") + "...\n.SH DESCRIPTION\n" + plain(own.text) + "\nEach command has its own page, and " +
            bold("--help") + " after its name lists its options.\n.SH COMMANDS\n";
    for (const auto& command : program.commands)
        page += ".TP\n\\fB" + plain(own.name + '-' + command.name) + "\\fP(1)\n" + plain(command.text) + ".\n";
    page += section("OPTIONS", own.options) + exit_status(own.footer);
    page += ".SH ENVIRONMENT\n.TP\n" + bold("TAUT_DEVICE") +
            "\nNumber or part of the name of the OpenCL device to use.\n.TP\n" + bold("TAUT_THREADS") +
            "\nHow many threads of the host work at a time.\n.TP\n" + bold("TAUT_CACHE_DIR") +
            "\nFolder of compiled programs, for drivers that keep none; 0: none are kept.\n.TP\n" + bold("TAUT_THEME") +
            "\nIf it is dark, pictures have a dark ground.\n";
    return page;
}

std::string man_page(const program_words& program, const command_words& command)
{
    const std::string& main = program.own.name;
    std::string page = header(main, main + '-' + command.name, command.text);
    page += ".SH SYNOPSIS\n" + bold(main) + ' ' + bold(command.name) + " [" + slanted("OPTION") + "...]";
    for (const auto& option : command.positionals)
    {
        const std::string shown = slanted(option.argument) + (option.repeated ? "..." : "");
        page += option.required ? ' ' + shown : " [" + shown + ']';
    }
    page += "\n.SH DESCRIPTION\n" + plain(command.text) + ".\n";
    page += section("ARGUMENTS", command.positionals) + section("OPTIONS", command.options);
    page += exit_status(command.footer) + ".SH SEE ALSO\n\\fB" + plain(main) + "\\fP(1)\n";
    return page;
}

} // namespace taut::tools
