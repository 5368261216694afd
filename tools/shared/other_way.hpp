// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <taut/impl/io/io_error.hpp>
#include <taut/impl/mesh/mesh_error.hpp>

namespace taut::tools
{

/// What the program offers, behind a message, where a map of one disk cannot be; empty if the command of that name
/// offers nothing.
std::string other_way(mesh_fault fault, std::string_view name);

/// The same for a file that a command does not read.
std::string other_way(const io::io_error& error, std::string_view name);

} // namespace taut::tools
