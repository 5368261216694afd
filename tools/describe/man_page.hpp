// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "describe/program_words.hpp"

namespace taut::tools
{

/// The page taut.1, in the language of man(7).
std::string man_page(const program_words& program);

/// The page taut-COMMAND.1.
std::string man_page(const program_words& program, const command_words& command);

} // namespace taut::tools
