// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/core/symbolic/emit.hpp>
#include <taut/impl/core/symbolic/row_program.hpp>
#include <taut/recording.hpp>

namespace taut
{

recording::recording(scalar_type real) : scope_(tape_)
{
    tape_.constants_in(real);
}

sym<idx> recording::global_id(unsigned dimension)
{
    if (dimension > 2) throw parameter_error("dimension", "a range has the dimensions 0, 1 and 2");
    return sym<idx>::of(tape_.intern({.op = impl::opcode::global_id, .type = scalar_type::i32, .payload = dimension}));
}

kernel_text recording::finish(std::string name, kernel_form form, kernel_use use) const
{
    require_identifier(name);
    if (form != kernel_form::host) return impl::emit(tape_, std::move(name), arguments_, form, use);
    auto rows = std::make_shared<const impl::row_program>(tape_, arguments_);
    auto by_index = impl::accessed_by_index(tape_, impl::schedule(tape_, tape_.stores()));
    std::vector<kernel_argument> all = arguments_;
    all.push_back({"taut_count", argument_kind::scalar, scalar_type::i32});
    return {std::move(name), {}, std::move(all), form, std::move(by_index), std::move(rows)};
}

void recording::store(std::uint32_t argument, scalar_type type, sym<idx> at, idx value)
{
    tape& t = tape::current();
    t.store(argument, at.id(), impl::build(t, impl::opcode::cast, type, value));
}

std::uint32_t recording::declare(std::string_view name, argument_kind kind, scalar_type type)
{
    std::string text = name.empty() ? impl::numbered("a", arguments_.size()) : std::string(name);
    require_identifier(text);
    if (std::any_of(arguments_.begin(), arguments_.end(), [&](const auto& a) { return a.name == text; }))
        throw parameter_error(text, "a kernel has two arguments of this name");
    arguments_.push_back({std::move(text), kind, type});
    return static_cast<std::uint32_t>(arguments_.size() - 1);
}

void recording::require_identifier(const std::string& name)
{
    const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
    const auto is_word = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
    if (name.empty() || is_digit(static_cast<unsigned char>(name[0])) ||
        !std::all_of(name.begin(), name.end(), is_word))
        throw parameter_error(name, "not a C identifier");
    if (name.starts_with("taut_")) throw parameter_error(name, "names with taut_ belong to the library");
    if (name.size() > 1 && (name[0] == 't' || name[0] == 'i') && std::all_of(name.begin() + 1, name.end(), is_digit))
        throw parameter_error(name, "t or i and a number names a value of the kernel");
}

} // namespace taut
