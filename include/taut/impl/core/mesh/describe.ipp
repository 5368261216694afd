// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/mesh/describe.hpp>

namespace taut::impl
{

std::string counted(std::size_t n, const std::string& thing, const std::string& things)
{
    return std::to_string(n) + ' ' + (n == 1 ? thing : things);
}

std::string list_first_ids(const char* thing, const char* things, std::size_t n, const std::vector<idx>& ids,
                           std::size_t group)
{
    constexpr std::size_t most = 5;
    const std::size_t shown = std::min(ids.size() / group, most);
    std::string s = counted(n, thing, things) + " (";
    for (std::size_t g = 0; g < shown; ++g)
    {
        if (g > 0) s += ", ";
        for (std::size_t k = 0; k < group; ++k)
        {
            if (k > 0) s += '-';
            s += std::to_string(ids[g * group + k]);
        }
    }
    return s + (n > shown ? ", ...)" : ")");
}

} // namespace taut::impl
