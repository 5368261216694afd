// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace taut::tools
{

/// Help whose descriptions are broken into lines.
class wrapped_help : public CLI::Formatter
{
public:
    std::string make_option_desc(const CLI::Option* option) const override;
    std::string make_option_opts(const CLI::Option* option) const override;
    std::string make_subcommand(const CLI::App* command) const override;

private:
    std::string wrapped(std::string_view text) const;
};

/// What was given and is none of a command's, with its like: "there is no option --out (did you mean --output?)"; empty
/// if all of it was expected.
std::string wrong_words(const CLI::App& program);

/// "there is no subcommand unwarp (did you mean unwrap?)" for a first argument that is none; empty if it is one, or an
/// option.
std::string wrong_subcommand(const CLI::App& program, int argc, const char* const* argv);

} // namespace taut::tools
