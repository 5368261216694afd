// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include "shared/options.hpp"

namespace taut::tools
{

/// A word and what it stands for.
template <class Value>
struct choice
{
    const char* word;
    Value value;
};

/// Adds an option that takes one of a few words; the first is the default and is written to `value` at once. The help
/// shows the words as `a|b|c`; any other word is a usage error that lists them.
template <class Value>
option add_choice(const subcommand& app, const std::string& name, Value& value,
                  std::initializer_list<choice<Value>> choices, const std::string& help)
{
    std::vector<std::string> words;
    std::vector<Value> values;
    for (const auto& one : choices)
    {
        words.emplace_back(one.word);
        values.push_back(one.value);
    }
    return app.add_choice(
        name, words, [&value, values](std::size_t k) { value = values[k]; }, help);
}

} // namespace taut::tools
