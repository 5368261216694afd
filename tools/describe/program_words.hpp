// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "shared/command_line.hpp"

namespace taut::tools
{

/// An option or a positional argument of a command, as its help says it.
struct option_words
{
    std::vector<std::string> names;   ///< "-o", "--output"; of a positional argument none
    std::string argument;             ///< "N", "FILE.csv"; of a flag nothing; of a positional argument its name
    std::vector<std::string> choices; ///< the words that it takes, if these are all
    std::string range;                ///< "[0 - 65535]", or nothing
    std::string usual;                ///< what counts where it is left out, or nothing
    std::string text;
    std::vector<std::string> needs; ///< other options
    bool is_file = false, repeated = false, required = false;
};

struct command_words
{
    std::string name; ///< "unwrap"; of the program "taut"
    std::string text, footer;
    std::vector<option_words> options, positionals;
};

/// All that the program's help says, without hidden commands.
struct program_words
{
    command_words own;
    std::vector<command_words> commands;
};

program_words describe(const command_line& program);

/// The first part of a text, for lists: up to a colon, a semicolon or the end of a sentence.
std::string first_words(const std::string& text);

} // namespace taut::tools
