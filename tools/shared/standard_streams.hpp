// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace taut::tools
{

/// A result must not land in a file that got the number of a closed standard stream, and a pipe that nobody reads any
/// more is an error like a full disk, so that nothing is left behind. Windows: bytes are written as they are.
void prepare_streams();

/// The words of the command line in UTF-8, the program's name first.
std::vector<std::string> words_of(int argc, char** argv);

/// Returns whether somebody may read what is written to an open file.
bool has_reader(int number) noexcept;

} // namespace taut::tools
