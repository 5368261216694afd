// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <vector>

#include <CLI/CLI.hpp>

#include "shared/options.hpp"

namespace taut::tools
{

/// The arguments of the program as CLI11 reads them, which know of each option that names files what they are for. So
/// all commands look at their files before they start, and batches know the files of a job.
class arguments : public CLI::App
{
public:
    using CLI::App::App;

    std::map<const CLI::Option*, file_use> files;
    std::map<const CLI::App*, std::map<std::string, std::string>> renamed; ///< options by their former names
};

/// Those that a command is one of.
inline arguments& arguments_of(const subcommand& command)
{
    return dynamic_cast<arguments&>(*command.known().get_parent());
}

} // namespace taut::tools
