// SPDX-License-Identifier: MIT
#include "shared/command_line.hpp"

#include <utility>

#include "shared/companions.hpp"
#include "shared/outputs.hpp"
#include "shared/tile_names.hpp"

namespace taut::tools
{

namespace
{

CLI::Validator dash_for(const char* stream)
{
    return {[=](std::string& given)
            {
                if (given == "-") given = stream;
                return std::string(given.empty() ? "the name is empty; name a file" : "");
            },
            ""};
}

template <class Paths>
CLI::Option* add_files(CLI::App& command, const std::string& name, Paths& paths, file_use use, const char* stream,
                       const std::string& help)
{
    std::string type = "FILE";
    for (const auto& e : use.extensions) type += (type.ends_with("FILE") ? "" : "|") + e;
    auto* const option = command.add_option(name, paths, help)->transform(dash_for(stream))->type_name(type);
    return declare_files(command, option, std::move(use));
}

/// Input of the k-th file of an option, where there is one for each.
std::filesystem::path source_of(const CLI::App& command, const CLI::Option& option, const file_use& use, std::size_t k)
{
    const auto* const made_of = use.made_of.empty() ? nullptr : command.get_option_no_throw(use.made_of);
    const bool one_each = made_of && made_of->count() == option.count();
    return one_each ? made_of->results()[k] : std::string();
}

} // namespace

CLI::Option* declare_files(CLI::App& command, CLI::Option* option, file_use use)
{
    dynamic_cast<command_line&>(*command.get_parent()).files.emplace(option, std::move(use));
    return option;
}

CLI::Option* add_input(CLI::App& command, const std::string& name, std::string& path, const std::string& read_as,
                       const std::string& help)
{
    return add_files(command, name, path, {.read_as = read_as}, standard_input, help);
}

CLI::Option* add_input(CLI::App& command, const std::string& name, std::vector<std::string>& paths,
                       const std::string& read_as, const std::string& help)
{
    return add_files(command, name, paths, {.read_as = read_as}, standard_input, help);
}

CLI::Option* add_input(CLI::App& command, const std::string& name, std::string& path, const file_use& use,
                       const std::string& help)
{
    return add_files(command, name, path, use, standard_input, help);
}

CLI::Option* add_output(CLI::App& command, const std::string& name, std::string& path, const file_use& use,
                        const std::string& help)
{
    return add_files(command, name, path, use, standard_output, help);
}

CLI::Option* add_output(CLI::App& command, const std::string& name, std::vector<std::string>& paths,
                        const file_use& use, const std::string& help)
{
    return add_files(command, name, paths, use, standard_output, help);
}

CLI::Option* add_stats(CLI::App& command, std::string& path)
{
    return add_output(command, "--stats", path, {.extensions = {".json"}}, "Write numbers as JSON");
}

std::vector<run_file> files_of(const CLI::App& command)
{
    std::vector<run_file> all;
    const auto& uses = dynamic_cast<const command_line&>(*command.get_parent()).files;
    for (const auto* option : command.get_options())
    {
        const auto found = uses.find(option);
        if (found == uses.end()) continue;
        const file_use& use = found->second;
        auto texts = option->results();
        if (texts.empty()) texts.push_back(use.otherwise);
        for (std::size_t k = 0; k < texts.size(); ++k)
        {
            const std::string& text = texts[k];
            const std::string given = use.file_in ? use.file_in(text) : text;
            if (given.empty()) continue;
            run_file file{option, &use, given, given, {}};
            // Tiles that are there; which of them a run writes, or needs, shows when it has read its surfaces.
            const auto tiles = use.tiles ? tile_files(given) : std::vector<std::filesystem::path>();
            for (const auto& tile : tiles) all.push_back({option, &use, tile, tile, {}});
            if (file.is_read())
            {
                if (tiles.empty()) all.push_back(file);
                for (auto& path : companions_of(given, use.with_images))
                    all.push_back({option, &use, given, std::move(path), {}});
                continue;
            }
            file.source = source_of(command, *option, use, k);
            for (auto& path : written_as(given, file.source))
                all.push_back({option, &use, given, std::move(path), file.source});
            if (const auto name = name_of_invalid(given); use.may_fail && !name.empty())
                all.push_back({option, &use, given, name, file.source});
        }
    }
    return all;
}

} // namespace taut::tools
