// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "shared/options.hpp"

namespace taut::tools
{

class arguments;

/// The program was given arguments that are none of its own.
class argument_error : public std::runtime_error
{
public:
    argument_error(const std::string& what, std::string remedy) : runtime_error(what), remedy_(std::move(remedy)) {}

    /// "`taut unwrap --help` lists the options"
    const std::string& remedy() const { return remedy_; }

private:
    std::string remedy_;
};

/// What the help of a program says beside its commands.
struct program_text
{
    std::string name, description, version, footer;
};

/// The command line of a program.
class command_line
{
public:
    explicit command_line(const program_text& text = {});
    ~command_line();
    command_line(command_line&&) = delete;

    subcommand add_subcommand(const std::string& name, const std::string& description);

    /// Reads the arguments of main(). Returns what is to be printed in place of a run, for --help and --version. Throws
    /// argument_error. `note` gets a line for each former name of an option among them, unless --quiet is, too.
    std::optional<std::string> parse(int argc, const char* const* argv,
                                     const std::function<void(const std::string&)>& note);

    /// Reads arguments, without the program's name; whether they are those of a run.
    bool accepts(const std::vector<std::string>& words);

    /// All of them, in the order in which they were added.
    std::vector<subcommand> subcommands() const;

    const arguments& known() const { return *known_; }

private:
    std::unique_ptr<arguments> known_;
};

/// A file that a run reads or writes: one that it was given, or one that belongs to it.
struct run_file
{
    tools::option option;
    const file_use* use;
    std::filesystem::path given, path;
    std::filesystem::path source; ///< of what is written: what it is made of, or nothing

    bool is_read() const { return !use->read_as.empty(); }
};

/// The files of a command whose arguments have been parsed, with all that belongs to them.
std::vector<run_file> files_of(const subcommand& command);

} // namespace taut::tools
