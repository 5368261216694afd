// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <set>

#include <taut/impl/core/compute/program/joined_source.hpp>

namespace taut::impl
{

std::string joined_source(const std::vector<kernel_text>& texts)
{
    std::string directives, helpers, kernels;
    std::set<std::string> names, known;
    for (const kernel_text& text : texts)
    {
        const std::string& source = text.source;
        if (!names.insert(text.name).second) throw parameter_error(text.name, "a program has two kernels of this name");
        if (source.empty()) continue; // of the host device
        const std::size_t kernel = source.find(text.form == kernel_form::part ? "static void " : "__kernel ");
        // Directives take a line each; a blank line precedes each helper, and there is none inside of it.
        for (std::size_t at = 0; at < kernel;)
        {
            const bool directive = source[at] == '#';
            const std::size_t last = source.find(directive ? "\n" : "\n\n", at + 1);
            const std::size_t end = last < kernel ? last + 1 : kernel;
            const std::string part = source.substr(at, end - at);
            if (known.insert(part).second) (directive ? directives : helpers) += part;
            at = end;
        }
        kernels += source.substr(kernel);
    }
    return directives + helpers + kernels;
}

} // namespace taut::impl
