// SPDX-License-Identifier: MIT
#include "shared/help.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <sstream>
#include <utility>
#include <vector>

namespace taut::tools
{

namespace
{

/// Edit distance of two words: letters to insert, delete or change.
std::size_t edit_distance(std::string_view from, std::string_view to)
{
    std::vector<std::size_t> row(to.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < from.size(); ++i)
    {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < to.size(); ++j)
        {
            const std::size_t change = diagonal + (from[i] == to[j] ? 0 : 1);
            diagonal = std::exchange(row[j + 1], std::min({row[j] + 1, row[j + 1] + 1, change}));
        }
    }
    return row.back();
}

/// Nearest of some words to a given one: one that begins with it, or is a third of its letters away, at most two;
/// empty: none.
std::string nearest_of(const std::vector<std::string>& words, const std::string& given)
{
    std::string nearest;
    const std::size_t letters = given.size() - std::min(given.find_first_not_of('-'), given.size());
    std::size_t least = std::clamp<std::size_t>(letters / 3, 1, 2) + 1; // of more changes, it is another word
    for (const auto& word : words)
    {
        const std::size_t distance = word.starts_with(given) ? 1 : edit_distance(given, word);
        if (distance < least) least = distance, nearest = word;
    }
    return nearest;
}

std::string there_is_no(const char* kind, const std::string& given, const std::string& nearest)
{
    return std::string("there is no ") + kind + ' ' + given +
           (nearest.empty() ? "" : " (did you mean " + nearest + "?)");
}

} // namespace

std::string wrapped_help::wrapped(std::string_view text) const
{
    constexpr std::size_t line_length = 100;
    std::string lines;
    std::size_t column = get_column_width();
    std::istringstream words{std::string(text)};
    for (std::string word; words >> word; column += word.size() + 1)
    {
        if (!lines.empty() && column + word.size() > line_length)
        {
            lines += '\n';
            column = get_column_width();
        }
        else if (!lines.empty())
            lines += ' ';
        lines += word;
    }
    return lines;
}

std::string wrapped_help::make_option_desc(const CLI::Option* option) const
{
    return wrapped(Formatter::make_option_desc(option));
}

std::string wrapped_help::make_option_opts(const CLI::Option* option) const
{
    std::string text = Formatter::make_option_opts(option);
    const auto replace = [&](const std::string& from, const std::string& to)
    {
        if (const auto at = text.find(from); at != std::string::npos) text.replace(at, from.size(), to);
    };
    replace("... ...", "...");
    replace(" Needs: ", " with ");
    const std::string range = ":INT in [";
    if (const auto at = text.find(range); at != std::string::npos)
    {
        const auto begin = at + range.size(), end = text.find(']', at);
        std::string bounds = text.substr(begin, end - begin);
        const bool said = at > 0 && text[at - 1] >= '0' && text[at - 1] <= '9'; // as 1..8
        const bool any = bounds.ends_with("2147483647");
        if (const auto dash = bounds.find(" - "); dash != std::string::npos) bounds.replace(dash, 3, " to ");
        text.replace(at, end + 1 - at, said || any ? "" : " (" + bounds + ")");
    }
    return text;
}

std::string wrapped_help::make_subcommand(const CLI::App* named) const
{
    std::ostringstream out;
    CLI::detail::format_help(out, named->get_name(), wrapped(named->get_description()), get_column_width());
    return out.str();
}

std::string wrong_words(const CLI::App& program)
{
    const auto parsed = program.get_subcommands();
    if (parsed.empty()) return {};
    const auto left = parsed.back()->remaining();
    const auto option = std::find_if(left.begin(), left.end(), [](const auto& word) { return word.starts_with('-'); });
    if (option == left.end())
        return left.empty() ? "" : "there is no place for " + left.front() + "; names with spaces need quotes";
    std::vector<std::string> names;
    for (const auto* known : parsed.back()->get_options())
        for (const auto& name : known->get_lnames()) names.push_back("--" + name);
    const std::string given = option->substr(0, option->find('='));
    if (!given.starts_with("--")) return there_is_no("option", given, {});
    const auto nearest = nearest_of(names, given);
    std::string others;
    for (const auto* other : program.get_subcommands([](const CLI::App*) { return true; }))
        if (nearest.empty() && other->get_option_no_throw(given))
            others += (others.empty() ? ", which is one of " : ", ") + other->get_name();
    return there_is_no("option", given, nearest) + others;
}

std::string wrong_subcommand(const CLI::App& program, int argc, const char* const* argv)
{
    if (argc < 2 || argv[1][0] == '-') return {};
    const std::string given = argv[1];
    std::vector<std::string> names;
    for (const auto* named : program.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(named->get_name());
    if (std::find(names.begin(), names.end(), given) != names.end()) return {};
    return there_is_no("subcommand", given, nearest_of(names, given));
}

} // namespace taut::tools
