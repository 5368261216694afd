// SPDX-License-Identifier: MIT
#include "shared/command_line.hpp"

#include <algorithm>
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

/// Words of the program, options by their present names; `changes` gets what was changed.
std::vector<std::string> with_present_names(const arguments& all, std::vector<std::string> words,
                                            std::vector<std::string>& changes)
{
    const auto renamed =
        std::find_if(all.renamed.begin(), all.renamed.end(),
                     [&](const auto& command) { return !words.empty() && command.first->get_name() == words.front(); });
    if (renamed == all.renamed.end()) return words;
    for (auto& word : words)
    {
        if (word == "--") break;
        const auto end = std::min(word.find('='), word.size());
        const auto found = renamed->second.find(word.substr(0, end));
        if (found == renamed->second.end()) continue;
        changes.push_back(found->first + " is now " + found->second);
        word = found->second + word.substr(end);
    }
    return words;
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

std::optional<std::string> command_line::parse(int argc, const char* const* argv,
                                               const std::function<void(const std::string&)>& note)
{
    std::string name = known_->get_name();
    if (const auto wrong = wrong_subcommand(*known_, argc, argv); !wrong.empty())
        throw argument_error(wrong, '`' + name + " --help` lists them");
    try
    {
        std::vector<std::string> changes;
        auto words = with_present_names(*known_, {argv + std::min(argc, 1), argv + argc}, changes);
        if (std::find(words.begin(), words.end(), "--quiet") == words.end())
            std::for_each(changes.begin(), changes.end(), note);
        std::reverse(words.begin(), words.end());
        known_->parse(std::move(words));
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
        std::vector<std::string> changes;
        auto present = with_present_names(*known_, words, changes);
        std::reverse(present.begin(), present.end());
        known_->parse(std::move(present));
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
