// SPDX-License-Identifier: MIT
#include "shared/options.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "shared/arguments.hpp"

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
option add_files(const subcommand& command, const std::string& name, Paths& paths, file_use use, const char* stream,
                 const std::string& help)
{
    std::string type = "FILE";
    for (const auto& e : use.extensions) type += (type.ends_with("FILE") ? "" : "|") + e;
    const option added = command.add_option(name, paths, help).type_name(type);
    added.known().transform(dash_for(stream));
    return declare_files(command, added, std::move(use));
}

} // namespace

text_check number_that(bool (*holds)(double), const char* otherwise)
{
    return [=](const std::string& text)
    {
        double x = 0;
        if (!CLI::detail::lexical_cast(text, x) || std::isnan(x)) return text + " is no number";
        return holds(x) ? std::string() : text + ' ' + otherwise;
    };
}

text_check whole_number()
{
    return [](const std::string& text)
    {
        int n = 0;
        if (CLI::detail::lexical_cast(text, n) && n >= 0) return std::string();
        return text + " is no whole number from 0 to " + std::to_string(std::numeric_limits<int>::max());
    };
}

const option& option::type_name(const std::string& name) const
{
    known_->type_name(name);
    return *this;
}

const option& option::required() const
{
    known_->required();
    return *this;
}

const option& option::needs(const std::string& other) const
{
    known_->needs(other);
    return *this;
}

const option& option::needs(const option& other) const
{
    known_->needs(other.known_);
    return *this;
}

const option& option::capture_default_str() const
{
    known_->capture_default_str();
    return *this;
}

const option& option::one_value_each() const
{
    known_->allow_extra_args(false);
    return *this;
}

const option& option::check(text_check fault) const
{
    known_->check(CLI::Validator(std::move(fault), ""));
    return *this;
}

const option& option::check_range(int least, int most) const
{
    known_->check(CLI::Range(least, most));
    return *this;
}

const option& option::check_said_range(int least, int most) const
{
    known_->check(CLI::Range(least, most).description(""));
    return *this;
}

const option& option::check_one_of(std::initializer_list<int> values) const
{
    known_->check(CLI::IsMember(std::vector<int>(values)).description(""));
    return *this;
}

std::string option::name() const
{
    return known_->get_snames().empty() ? known_->get_name() : '-' + known_->get_snames().front();
}

option subcommand::add_option(const std::string& name, std::string& value, const std::string& help) const
{
    return option(known_->add_option(name, value, help));
}

option subcommand::add_option(const std::string& name, std::vector<std::string>& values, const std::string& help) const
{
    return option(known_->add_option(name, values, help));
}

option subcommand::add_option(const std::string& name, int& value, const std::string& help) const
{
    return option(known_->add_option(name, value, help));
}

option subcommand::add_option(const std::string& name, unsigned short& value, const std::string& help) const
{
    return option(known_->add_option(name, value, help));
}

option subcommand::add_option(const std::string& name, double& value, const std::string& help) const
{
    return option(known_->add_option(name, value, help));
}

option subcommand::add_option(const std::string& name, std::optional<int>& value, const std::string& help) const
{
    return option(known_->add_option(name, value, help));
}

option subcommand::add_option(const std::string& name, std::optional<double>& value, const std::string& help) const
{
    return option(known_->add_option(name, value, help));
}

option subcommand::add_option_function(const std::string& name, const std::function<void(double)>& set,
                                       const std::string& help) const
{
    return option(known_->add_option_function<double>(name, set, help));
}

option subcommand::add_flag(const std::string& name, bool& value, const std::string& help) const
{
    return option(known_->add_flag(name, value, help));
}

option subcommand::add_choice(const std::string& name, const std::vector<std::string>& words,
                              const std::function<void(std::size_t)>& set, const std::string& help) const
{
    set(0);
    std::string shown;
    for (const auto& word : words) shown += (shown.empty() ? "" : "|") + word;
    const std::function<void(const std::string&)> chosen = [=](const std::string& given)
    {
        for (std::size_t k = 0; k < words.size(); ++k)
            if (words[k] == given) set(k);
    };
    auto known = CLI::IsMember(words);
    known.description(""); // the words already stand in the type name
    auto* const added = known_->add_option_function<std::string>(name, chosen, help);
    return option(added->type_name(shown)->default_str(words.front())->check(known));
}

void subcommand::rename(const std::string& former, const std::string& name) const
{
    arguments_of(*this).renamed[known_].emplace(former, name);
}

void subcommand::footer(const std::string& text) const
{
    known_->footer(text);
}

void subcommand::hide() const
{
    known_->group("");
}

void subcommand::remove(const std::string& name) const
{
    auto* const known = known_->get_option_no_throw(name);
    if (known == nullptr) return;
    arguments_of(*this).files.erase(known);
    std::erase_if(arguments_of(*this).renamed[known_], [&](const auto& names) { return names.second == name; });
    known_->remove_option(known);
}

void subcommand::describe(const std::string& name, const std::string& help) const
{
    known_->get_option(name)->description(help);
}

file_use& subcommand::use_of(const std::string& name) const
{
    return arguments_of(*this).files.at(known_->get_option(name));
}

std::string subcommand::name() const
{
    return known_->get_name();
}

bool subcommand::has(const std::string& option) const
{
    return known_->get_option_no_throw(option) != nullptr;
}

bool subcommand::given(const std::string& option) const
{
    return known_->count(option) > 0;
}

bool subcommand::parsed() const
{
    return known_->parsed();
}

option declare_files(const subcommand& command, const option& of, file_use use)
{
    arguments_of(command).files.emplace(&of.known(), std::move(use));
    return of;
}

option add_input(const subcommand& command, const std::string& name, std::string& path, const std::string& read_as,
                 const std::string& help)
{
    return add_files(command, name, path, {.read_as = read_as}, standard_input, help);
}

option add_input(const subcommand& command, const std::string& name, std::vector<std::string>& paths,
                 const std::string& read_as, const std::string& help)
{
    return add_files(command, name, paths, {.read_as = read_as}, standard_input, help);
}

option add_input(const subcommand& command, const std::string& name, std::string& path, const file_use& use,
                 const std::string& help)
{
    return add_files(command, name, path, use, standard_input, help);
}

option add_output(const subcommand& command, const std::string& name, std::string& path, const file_use& use,
                  const std::string& help)
{
    return add_files(command, name, path, use, standard_output, help);
}

option add_output(const subcommand& command, const std::string& name, std::vector<std::string>& paths,
                  const file_use& use, const std::string& help)
{
    return add_files(command, name, paths, use, standard_output, help);
}

option add_stats(const subcommand& command, std::string& path)
{
    return add_output(command, "--stats", path, {.extensions = {".json"}}, "Write numbers as JSON");
}

} // namespace taut::tools
