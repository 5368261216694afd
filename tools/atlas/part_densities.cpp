// SPDX-License-Identifier: MIT
#include "atlas/part_densities.hpp"

#include <charconv>
#include <cstddef>
#include <filesystem>
#include <set>
#include <system_error>

#include "shared/failure.hpp"

namespace taut::tools
{

namespace
{

/// "'body', 'hat', 'shoe' and 4 more"
std::string listed(const std::set<std::string>& names)
{
    constexpr std::size_t most = 20;
    std::string text;
    std::size_t n = 0;
    for (const auto& name : names)
    {
        if (n++ == most) break;
        text += (text.empty() ? "'" : ", '") + name + '\'';
    }
    return names.size() > most ? text + " and " + std::to_string(names.size() - most) + " more" : text;
}

[[noreturn]] void refuse(const std::string& name, const std::set<std::string>& names)
{
    throw unsuitable_input(
        "--density " + name + ": the input has no part of this name; " +
        (names.empty() ? "it names none: name its meshes, materials or groups" : "there are " + listed(names)));
}

} // namespace

std::optional<part_density> density_in(std::string_view text)
{
    const auto sign = text.rfind('=');
    if (sign == text.npos || sign == 0) return {};
    const std::string_view number = text.substr(sign + 1);
    double factor = 0;
    const auto [end, fault] = std::from_chars(number.data(), number.data() + number.size(), factor);
    if (fault != std::errc() || end != number.data() + number.size() || !(factor >= 1e-3 && factor <= 1e3)) return {};
    return part_density{std::string(text.substr(0, sign)), factor};
}

std::vector<double> densities_of(const std::vector<std::unique_ptr<atlas_source>>& sources,
                                 std::span<const std::string> inputs, std::span<const std::string> given)
{
    std::vector<double> result;
    if (given.empty()) return result;
    std::set<std::string> names;
    for (std::size_t i = 0; i < sources.size(); ++i)
    {
        names.merge(sources[i]->part_names());
        if (sources.size() > 1) names.insert(inputs[i]);
        result.resize(result.size() + sources[i]->surface().cells().size(), 1.0);
    }
    for (const std::string& text : given)
    {
        const part_density wanted = *density_in(text);
        bool found = false;
        std::size_t first = 0;
        for (std::size_t i = 0; i < sources.size(); ++i)
        {
            const std::size_t count = sources[i]->surface().cells().size();
            const bool whole = sources.size() > 1 &&
                               (inputs[i] == wanted.name || std::filesystem::path(inputs[i]).filename() == wanted.name);
            const auto own = whole ? std::vector<char>(count, 1) : sources[i]->triangles_of(wanted.name);
            for (std::size_t c = 0; c < own.size(); ++c)
                if (own[c] != 0)
                {
                    result[first + c] *= wanted.factor;
                    found = true;
                }
            first += count;
        }
        if (!found) refuse(wanted.name, names);
    }
    return result;
}

} // namespace taut::tools
