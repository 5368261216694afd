// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <taut/errors.hpp>

namespace taut::tools
{

/// Alternative that the program offers, after a message, where a surface is no disk; empty if the command has none.
std::string other_way(mesh_error::fault_type fault, std::string_view name);

/// The same for a file that a command does not read.
std::string other_way(const io::io_error& error, std::string_view name);

} // namespace taut::tools
