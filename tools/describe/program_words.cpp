// SPDX-License-Identifier: MIT
#include "describe/program_words.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <sstream>
#include <string_view>
#include <utility>

#include "shared/arguments.hpp"

namespace taut::tools
{

namespace
{

/// The words of "free|circle|square", or none if that is a kind of value: "FILE.png|.svg", "N".
std::vector<std::string> choices_of(const std::string& type)
{
    if (type.find('|') == std::string::npos) return {};
    constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz0123456789+-|";
    if (type.find_first_not_of(letters) != std::string::npos) return {};
    std::vector<std::string> words;
    std::istringstream in(type);
    for (std::string word; std::getline(in, word, '|');) words.push_back(word);
    return words;
}

option_words words_of(const CLI::Option& option, const std::map<const CLI::Option*, file_use>& files)
{
    option_words words;
    for (const auto& name : option.get_snames()) words.names.push_back('-' + name);
    for (const auto& name : option.get_lnames()) words.names.push_back("--" + name);
    words.text = option.get_description();
    words.required = option.get_required();
    words.is_file = files.contains(&option);
    for (const auto* other : option.get_needs()) words.needs.push_back(other->get_name());
    if (option.get_items_expected_max() == 0) return words;

    const std::string type = option.get_type_name();
    const std::size_t colon = std::min(type.find(':'), type.size());
    const std::size_t bracket = type.find('[', colon);
    words.argument = option.get_positional() ? option.get_name(true) : type.substr(0, colon);
    if (bracket != std::string::npos) words.range = type.substr(bracket);
    words.choices = choices_of(words.argument);
    words.usual = option.get_default_str();
    words.repeated = option.get_expected_max() == CLI::detail::expected_max_vector_size;
    return words;
}

command_words words_of(const CLI::App& app, const std::map<const CLI::Option*, file_use>& files)
{
    command_words words{app.get_name(), app.get_description(), app.get_footer(), {}, {}};
    for (const auto* option : app.get_options())
        if (!option->get_group().empty())
            (option->get_positional() ? words.positionals : words.options).push_back(words_of(*option, files));
    return words;
}

} // namespace

program_words describe(const command_line& line)
{
    const arguments& program = line.known();
    program_words words{words_of(program, program.files), {}};
    for (const auto* app : program.get_subcommands([](const CLI::App*) { return true; }))
        if (!app->get_group().empty()) words.commands.push_back(words_of(*app, program.files));
    return words;
}

std::string first_words(const std::string& text)
{
    std::size_t end = text.size();
    for (const char* mark : {": ", "; ", ". ", " ("}) end = std::min(end, text.find(mark));
    return text.substr(0, end);
}

} // namespace taut::tools
