// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

// Commands declare their options by this header; CLI11, which compiles for long, is the business of shared/.
namespace CLI
{
class App;
class Option;
} // namespace CLI

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

/// What is wrong with the text that an option is given; empty: nothing.
using text_check = std::function<std::string(const std::string&)>;

/// Checks whose messages are sentences; CLI11's own write the range out to the last digit.
text_check number_that(bool (*holds)(double), const char* otherwise);
text_check whole_number();

/// An option of a command.
class option
{
public:
    explicit option(CLI::Option* known) : known_(known) {}

    const option& type_name(const std::string& name) const;
    const option& required() const;
    const option& needs(const std::string& other) const;
    const option& needs(const option& other) const;
    /// The help shows the value that the variable has now.
    const option& capture_default_str() const;
    /// Further values need the name of the option again.
    const option& one_value_each() const;

    const option& check(text_check fault) const;
    /// Whole numbers from `least` to `most`; the help says so, too.
    const option& check_range(int least, int most) const;
    /// The same, where the option's own words say it.
    const option& check_said_range(int least, int most) const;
    const option& check_one_of(std::initializer_list<int> values) const;

    /// As the user knows it: "-o", "--stats", "IN".
    std::string name() const;

    CLI::Option& known() const { return *known_; }
    bool operator==(const option&) const = default;

private:
    CLI::Option* known_;
};

/// A command of the program, and its options. A handle: copies are the same command.
class subcommand
{
public:
    explicit subcommand(CLI::App* known) : known_(known) {}

    /// The value is written when the arguments are parsed.
    option add_option(const std::string& name, std::string& value, const std::string& help = {}) const;
    option add_option(const std::string& name, std::vector<std::string>& values, const std::string& help = {}) const;
    option add_option(const std::string& name, int& value, const std::string& help = {}) const;
    option add_option(const std::string& name, unsigned short& value, const std::string& help = {}) const;
    option add_option(const std::string& name, double& value, const std::string& help = {}) const;
    option add_option(const std::string& name, std::optional<int>& value, const std::string& help = {}) const;
    option add_option(const std::string& name, std::optional<double>& value, const std::string& help = {}) const;
    option add_option_function(const std::string& name, const std::function<void(double)>& set,
                               const std::string& help) const;
    option add_flag(const std::string& name, bool& value, const std::string& help) const;

    /// An option that takes one of a few words, of which the first is the default: `set` gets its number.
    option add_choice(const std::string& name, const std::vector<std::string>& words,
                      const std::function<void(std::size_t)>& set, const std::string& help) const;

    /// The option is taken by a former name, too, with a note. Help and completion do not list it.
    void rename(const std::string& former, const std::string& name) const;

    void footer(const std::string& text) const;
    /// The help of the program does not list it.
    void hide() const;

    // Of another program's command, with other options:
    void remove(const std::string& name) const; ///< if it has such an option
    void describe(const std::string& name, const std::string& help) const;
    file_use& use_of(const std::string& name) const;

    std::string name() const;
    bool has(const std::string& option) const;
    bool parsed() const;
    bool given(const std::string& option) const;

    CLI::App& known() const { return *known_; }

private:
    CLI::App* known_;
};

/// Says what the files of an option are for. Each option that names files is declared so, or by the functions below.
option declare_files(const subcommand& command, const option& of, file_use use);

/// Options that name files to read, one or several; - stands for standard input.
option add_input(const subcommand& command, const std::string& name, std::string& path, const std::string& read_as,
                 const std::string& help);
option add_input(const subcommand& command, const std::string& name, std::vector<std::string>& paths,
                 const std::string& read_as, const std::string& help);
option add_input(const subcommand& command, const std::string& name, std::string& path, const file_use& use,
                 const std::string& help);

/// Options that name files to write; - stands for standard output.
option add_output(const subcommand& command, const std::string& name, std::string& path, const file_use& use,
                  const std::string& help);
option add_output(const subcommand& command, const std::string& name, std::vector<std::string>& paths,
                  const file_use& use, const std::string& help);

/// --stats
option add_stats(const subcommand& command, std::string& path);

} // namespace taut::tools
