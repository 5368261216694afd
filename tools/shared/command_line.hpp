// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace taut::tools
{

/// Files that - means on the command line.
inline constexpr const char *standard_input = "/dev/stdin", *standard_output = "/dev/stdout";

/// Use of the files of an option by a command.
struct file_use
{
    /// Name of input files in messages: "the pins". Empty: the files are written.
    std::string read_as = {};

    bool tiles = false;       ///< a name with <UDIM> stands for the files of all tiles
    bool with_images = false; ///< images that a model of glTF names beside itself are read, too

    // Of files that are written:
    std::vector<std::string> extensions = {}; ///< in small letters; none: any will do
    std::string made_of = {};                 ///< the option whose k-th file the k-th one of this is made of
    std::string otherwise = {};               ///< the file where the option is left out
    bool in_place = false;                    ///< it may replace that file
    bool may_fail = false;                    ///< name_of_invalid() is written where there is no valid map
    bool may_be_folder = false;               ///< a mesh in pieces: the command judges the folder

    /// The file in what is given, or nothing; none: what is given is the file.
    std::function<std::string(const std::string&)> file_in = {};
};

/// The arguments of the program, which know of each option that names files what they are for. So all commands look at
/// their files before they start, and batches know the files of a job.
class command_line : public CLI::App
{
public:
    using CLI::App::App;

    std::map<const CLI::Option*, file_use> files;
};

/// Says what the files of an option are for. Each option that names files is declared so, or by the functions below.
CLI::Option* declare_files(CLI::App& command, CLI::Option* option, file_use use);

/// Options that name files to read, one or several; - stands for standard input.
CLI::Option* add_input(CLI::App& command, const std::string& name, std::string& path, const std::string& read_as,
                       const std::string& help);
CLI::Option* add_input(CLI::App& command, const std::string& name, std::vector<std::string>& paths,
                       const std::string& read_as, const std::string& help);
CLI::Option* add_input(CLI::App& command, const std::string& name, std::string& path, const file_use& use,
                       const std::string& help);

/// Options that name files to write; - stands for standard output.
CLI::Option* add_output(CLI::App& command, const std::string& name, std::string& path, const file_use& use,
                        const std::string& help);
CLI::Option* add_output(CLI::App& command, const std::string& name, std::vector<std::string>& paths,
                        const file_use& use, const std::string& help);

/// --stats
CLI::Option* add_stats(CLI::App& command, std::string& path);

/// A file that a run reads or writes: one that it was given, or one that belongs to it.
struct run_file
{
    const CLI::Option* option;
    const file_use* use;
    std::filesystem::path given, path;
    std::filesystem::path source; ///< of what is written: what it is made of, or nothing

    bool is_read() const { return !use->read_as.empty(); }
};

/// The files of a command whose arguments have been parsed, with all that belongs to them.
std::vector<run_file> files_of(const CLI::App& command);

} // namespace taut::tools
