// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>

#include <taut/impl/core/compute/program/signature.hpp>

namespace taut::impl
{

parameter parse_parameter(std::string_view text, scalar_type real)
{
    parameter p;
    p.is_memory = text.find('*') != std::string_view::npos;
    std::string word;
    const auto end_word = [&]
    {
        if (word.empty() || word == "const" || word == "restrict" || word == "__global" || word == "global") return;
        if (p.type.empty())
            p.type = word == "REAL" ? std::string(spelling(real)) : word;
        else
            p.name = word;
    };
    for (const char c : text)
    {
        const bool part = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
        if (part)
            word += c;
        else
            end_word(), word.clear();
    }
    end_word();
    return p;
}

std::vector<parameter> signature_of(std::string_view source, std::string_view name, scalar_type real)
{
    std::vector<parameter> parameters;
    const std::string head = "void " + std::string(name) + "(";
    std::size_t at = source.find(head);
    if (at == std::string_view::npos) return parameters;
    at += head.size();
    const std::string_view list = source.substr(at, source.find(')', at) - at);
    for (std::size_t begin = 0; begin < list.size();)
    {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        parameters.push_back(parse_parameter(list.substr(begin, end - begin), real));
        begin = end + 1;
    }
    return parameters;
}

} // namespace taut::impl
