// SPDX-License-Identifier: MIT
#pragma once

#include <cctype>
#include <cstddef>
#include <iomanip>
#include <sstream>

#include <taut/impl/core/compute/program/build_excerpt.hpp>

namespace taut::impl
{

std::set<int> lines_named(const std::string& log)
{
    std::set<int> lines;
    const auto digit = [&](std::size_t i)
    { return i < log.size() && std::isdigit(static_cast<unsigned char>(log[i])); };
    for (std::size_t i = 0; i + 1 < log.size(); ++i)
    {
        if (log[i] != ':' || !digit(i + 1)) continue;
        std::size_t end = i + 1;
        int line = 0;
        while (digit(end) && line < 10000000) line = 10 * line + (log[end++] - '0');
        // A column follows a line number; this keeps clock times and column numbers out.
        if (end + 1 < log.size() && log[end] == ':' && digit(end + 1)) lines.insert(line);
        i = end - 1;
    }
    return lines;
}

std::string build_excerpt(const std::string& source, const std::string& log)
{
    std::set<int> wanted = lines_named(log);
    if (wanted.empty()) wanted = {3};

    std::istringstream in(source);
    std::string text, line;
    int number = 1, last_shown = 0;
    while (std::getline(in, line))
    {
        int restart = 0;
        std::string file;
        std::istringstream directive(line.rfind("#line ", 0) == 0 ? line.substr(6) : "");
        // Oclgrind numbers physical lines instead; then the log does not name the directive's file either.
        if (directive >> restart >> std::quoted(file) && log.find(file) != std::string::npos)
        {
            number = restart;
            continue;
        }
        const auto near = wanted.lower_bound(number - 2);
        if (near != wanted.end() && *near <= number + 2)
        {
            if (last_shown != 0 && last_shown + 1 != number) text += "      ...\n";
            const std::string label = std::to_string(number);
            text.append(label.size() < 5 ? 5 - label.size() : 0, ' ');
            text += label;
            text += wanted.count(number) ? " > " : " | ";
            text += line;
            text += '\n';
            last_shown = number;
        }
        ++number;
    }
    return text;
}

} // namespace taut::impl
