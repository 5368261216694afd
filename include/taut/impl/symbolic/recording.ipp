// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cctype>
#include <utility>

#include <taut/impl/symbolic/recording.hpp>

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

impl::kernel_text recording::finish(std::string name, impl::kernel_form form, impl::kernel_use use) const
{
    require_identifier(name);
    return impl::emit(tape_, std::move(name), arguments_, form, use);
}

std::uint32_t recording::declare(std::string_view name, impl::argument_kind kind, scalar_type type)
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
