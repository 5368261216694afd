// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

#include <taut/impl/dist/ranges/line_layout.hpp>

namespace taut::dist::impl
{

/// Collective. TetGen's .node and .ele, and .face if there is one. Throws unsuited.
inline line_layout tetgen_lines(const communicator& all, const std::filesystem::path& path)
{
    line_layout layout;
    struct head
    {
        std::array<std::int64_t, 4> n{};
    };
    const auto open = [&](const char* extension)
    {
        layout.texts.push_back(
            std::make_unique<text_ranges>(all, std::filesystem::path(path).replace_extension(extension), '#',
                                          [](std::string_view line) { return blank_or(line, '#', line_kind::item); }));
        layout.extensions.emplace_back(extension);
        head h;
        const std::string line = layout.texts.back()->lines(0, 1).at(0);
        const tokens words(line, '#');
        for (std::size_t k = 0; k < std::min<std::size_t>(4, words.size()); ++k) h.n[k] = words.integer(k);
        if (h.n[0] < 0 || h.n[0] > layout.texts.back()->items() - 1) throw unsuited("it has not one item a line");
        return h.n;
    };
    const auto marker = [](double x)
    {
        if (x != std::floor(x) || std::abs(x) > 1e15) throw unsuited("a marker is no whole number");
        return static_cast<std::int64_t>(x);
    };
    group_names* const names = layout.groups.get();

    const auto [points, dimension, attributes, marked] = open(".node");
    if (dimension != 3 || attributes < 0 || attributes > 16) throw unsuited("it is not of three dimensions");
    layout.vertices = points;
    layout.sections.push_back(
        {.what = line_section::content::vertices, .text = 0, .items = {1, points}, .word = 1, .numbered = true});
    if (marked != 0)
        layout.sections.back().group = [=, at = static_cast<std::size_t>(4 + attributes)](const tokens& w)
        { return names->tagged("points", marker(w.real(at)), 0); };

    const auto [elements, corners, regions, unused] = open(".ele");
    if (corners != 4) throw unsuited("it has a high order");
    layout.sections.push_back({.what = line_section::content::cells,
                               .text = 1,
                               .items = {1, elements},
                               .cell = [=, any = regions > 0](const tokens& w, line_cell& c)
                               {
                                   c.kind = io::cell_kind::tetrahedron;
                                   c.take(w, 1);
                                   const double a = any ? w.real(5) : 0.5;
                                   if (a != std::floor(a) || std::abs(a) >= 1e15) return;
                                   c.labels[0] = static_cast<std::int64_t>(a);
                                   c.groups.push_back(names->tagged("tetrahedra", static_cast<std::int64_t>(a), 3));
                               }});
    std::error_code unknown;
    if (!all.any(std::filesystem::exists(std::filesystem::path(path).replace_extension(".face"), unknown)))
        return layout;
    const auto faces = open(".face");
    layout.sections.push_back({.what = line_section::content::cells,
                               .text = 2,
                               .items = {1, faces[0]},
                               .cell = [=, any = faces[1] != 0](const tokens& w, line_cell& c)
                               {
                                   c.kind = io::cell_kind::triangle;
                                   c.take(w, 1);
                                   if (!any) return;
                                   c.labels[0] = marker(w.real(4));
                                   c.groups.push_back(names->tagged("faces", c.labels[0], 2));
                               }});
    return layout;
}

} // namespace taut::dist::impl
