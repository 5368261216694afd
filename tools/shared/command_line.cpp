// SPDX-License-Identifier: MIT
#include "shared/command_line.hpp"

#include <iostream>
#include <sstream>
#include <utility>

#include "shared/arguments.hpp"
#include "shared/companions.hpp"
#include "shared/help.hpp"
#include "shared/outputs.hpp"
#include "shared/tile_names.hpp"

namespace taut::tools
{

namespace
{

/// Input of the k-th file of an option, where there is one for each.
std::filesystem::path source_of(const CLI::App& command, const CLI::Option& option, const file_use& use, std::size_t k)
{
    const auto* const made_of = use.made_of.empty() ? nullptr : command.get_option_no_throw(use.made_of);
    const bool one_each = made_of && made_of->count() == option.count();
    return one_each ? made_of->results()[k] : std::string();
}

} // namespace

command_line::command_line(const program_text& text) : known_(std::make_unique<arguments>(text.description, text.name))
{
    if (!text.version.empty()) known_->set_version_flag("--version", text.version);
    known_->require_subcommand(1);
    known_->formatter(std::make_shared<wrapped_help>());
    known_->footer(text.footer);
}

command_line::~command_line() = default;

subcommand command_line::add_subcommand(const std::string& name, const std::string& description)
{
    return subcommand(known_->add_subcommand(name, description));
}

std::optional<std::string> command_line::parse(int argc, const char* const* argv)
{
    std::string name = known_->get_name();
    if (const auto wrong = wrong_subcommand(*known_, argc, argv); !wrong.empty())
        throw argument_error(wrong, '`' + name + " --help` lists them");
    try
    {
        known_->parse(argc, argv);
        return {};
    }
    catch (const CLI::Success& e) // --help, --version
    {
        std::ostringstream text;
        known_->exit(e, text, std::cerr);
        return text.str();
    }
    catch (const CLI::ParseError& e)
    {
        for (const auto* app : known_->get_subcommands()) name += ' ' + app->get_name();
        const auto wrong = wrong_words(*known_);
        throw argument_error(wrong.empty() ? e.what() : wrong, '`' + name + " --help` lists the options");
    }
}

bool command_line::accepts(const std::vector<std::string>& words)
{
    try
    {
        known_->parse(std::vector<std::string>(words.rbegin(), words.rend()));
        return true;
    }
    catch (const CLI::Error&) // --help is one, too
    {
        return false;
    }
}

std::vector<subcommand> command_line::subcommands() const
{
    std::vector<subcommand> all;
    for (auto* app : known_->get_subcommands({})) all.emplace_back(app);
    return all;
}

std::vector<run_file> files_of(const subcommand& command)
{
    std::vector<run_file> all;
    const auto& uses = arguments_of(command).files;
    const auto& app = command.known();
    for (auto* known : command.known().get_options())
    {
        const auto found = uses.find(known);
        if (found == uses.end()) continue;
        const file_use& use = found->second;
        const option named(known);
        auto texts = known->results();
        if (texts.empty()) texts.push_back(use.otherwise);
        for (std::size_t k = 0; k < texts.size(); ++k)
        {
            const std::string& text = texts[k];
            const std::string given = use.file_in ? use.file_in(text) : text;
            if (given.empty()) continue;
            run_file file{named, &use, given, given, {}};
            // Tiles that are there; which of them a run writes, or needs, shows when it has read its surfaces.
            const auto tiles = use.tiles ? tile_files(given) : std::vector<std::filesystem::path>();
            for (const auto& tile : tiles) all.push_back({named, &use, tile, tile, {}});
            if (file.is_read())
            {
                if (tiles.empty()) all.push_back(file);
                for (auto& path : companions_of(given, use.with_images))
                    all.push_back({named, &use, given, std::move(path), {}});
                continue;
            }
            file.source = source_of(app, *known, use, k);
            for (auto& path : written_as(given, file.source))
                all.push_back({named, &use, given, std::move(path), file.source});
            if (const auto name = name_of_invalid(given); use.may_fail && !name.empty())
                all.push_back({named, &use, given, name, file.source});
        }
    }
    return all;
}

} // namespace taut::tools
