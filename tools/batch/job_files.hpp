// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace taut::tools::batch
{

/// The files that a job names.
struct job_files
{
    std::vector<std::string> inputs, outputs;
    std::vector<std::string> tiles; ///< those of outputs that have <UDIM> in their names, for files of all tiles
    std::string stats;              ///< what --stats names, one of the outputs or standard output; or empty
};

/// Knows the program's options, and so which arguments of a job are files.
class argument_reader
{
public:
    argument_reader();
    ~argument_reader();

    /// None for arguments that the program would refuse.
    job_files files(const std::vector<std::string>& args);

private:
    struct program;
    std::unique_ptr<program> program_;
};

} // namespace taut::tools::batch
