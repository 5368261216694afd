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

std::string wrapped_help::make_subcommand(const CLI::App* named) const
{
    std::ostringstream out;
    CLI::detail::format_help(out, named->get_name(), wrapped(named->get_description()), get_column_width());
    return out.str();
}

std::string wrong_subcommand(const CLI::App& program, int argc, const char* const* argv)
{
    if (argc < 2 || argv[1][0] == '-') return {};
    const std::string given = argv[1];
    std::string nearest;
    std::size_t least = 3; // of more changes, it is another word
    for (const auto* named : program.get_subcommands([](const CLI::App*) { return true; }))
    {
        const std::size_t distance = edit_distance(given, named->get_name());
        if (distance == 0) return {};
        if (distance < least) least = distance, nearest = named->get_name();
    }
    return "there is no subcommand " + given + (nearest.empty() ? "" : " (did you mean " + nearest + "?)");
}

} // namespace taut::tools
