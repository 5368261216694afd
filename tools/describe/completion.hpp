// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "describe/program_words.hpp"

namespace taut::tools
{

/// Scripts that complete commands, options, and words that options take, in the language of each shell. They name all
/// of these, so that the program is not run for a completion.
std::string bash_completion(const program_words& program);
std::string zsh_completion(const program_words& program);
std::string fish_completion(const program_words& program);

} // namespace taut::tools
