// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace taut::tools
{

/// A word and what it stands for.
template <class Value>
using choice = std::pair<std::string, Value>;

/// Adds an option that takes one of a few words; the first is the default and is written to `value` at once. The help
/// shows the words as `a|b|c`; any other word is a usage error that lists them.
template <class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Value& value, std::vector<choice<Value>> choices,
                        const std::string& help)
{
    value = choices.front().second;
    std::vector<std::string> words;
    std::string shown;
    for (const auto& [word, meaning] : choices)
    {
        words.push_back(word);
        shown += (shown.empty() ? "" : "|") + word;
    }
    const std::string first = words.front();
    const auto set = [&value, choices = std::move(choices)](const std::string& given)
    {
        for (const auto& [word, meaning] : choices)
            if (word == given) value = meaning;
    };
    auto known = CLI::IsMember(std::move(words));
    known.description(""); // the words already stand in the type name
    return app.add_option_function<std::string>(name, set, help)->type_name(shown)->default_str(first)->check(known);
}

} // namespace taut::tools
