// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include <taut/impl/dist/ranges/line_layout.hpp>
#include <taut/impl/files/file/scanner.hpp>

namespace taut::dist::impl
{

/// A section of cells of MEDIT's.
struct medit_section
{
    std::string_view keyword;
    io::cell_kind kind;
    std::string_view group;
    bool tagged;

    /// The section of a keyword; none for what has no cells. Throws unsuited for cells that are not read by ranges.
    static const medit_section* of(std::string_view keyword)
    {
        static constexpr std::array<medit_section, 9> known = {{
            {"Edges", io::cell_kind::line, "edges", true},
            {"Triangles", io::cell_kind::triangle, "triangles", true},
            {"Quadrilaterals", io::cell_kind::quad, "quadrilaterals", true},
            {"Tetrahedra", io::cell_kind::tetrahedron, "tetrahedra", true},
            {"Corners", io::cell_kind::vertex, "corners", false},
            {"RequiredVertices", io::cell_kind::vertex, "required_vertices", false},
            {"Hexahedra", io::cell_kind::hexahedron, "hexahedra", true},
            {"Prisms", io::cell_kind::wedge, "prisms", true},
            {"Pyramids", io::cell_kind::pyramid, "pyramids", true},
        }};
        const auto same = [&](std::string_view other) { return io::impl::same_letters(keyword, other); };
        if (keyword.size() > 2 && keyword.back() >= '2' && keyword.back() <= '9') throw unsuited("it has a high order");
        if (same("Pentahedra") || same("Hexaedra")) throw unsuited("it has cells of a kind that is not read by ranges");
        const auto* found = std::find_if(known.begin(), known.end(), [&](const auto& s) { return same(s.keyword); });
        return found == known.end() ? nullptr : found;
    }

    /// The cells in a range of items.
    line_section in(item_range items, group_names& groups) const
    {
        return {.what = line_section::content::cells,
                .text = 0,
                .items = items,
                .cell = [s = *this, names = &groups](const tokens& w, line_cell& c)
                {
                    c.kind = s.kind;
                    c.take(w, 0, wedge_order::turned);
                    const auto n = static_cast<std::size_t>(io::impl::shape_of(s.kind).corners);
                    if (s.tagged) c.labels[0] = w.integer(n);
                    c.groups.push_back(s.tagged ? names->tagged(std::string(s.group), w.integer(n), c.dimension())
                                                : names->number({std::string(s.group), 0, false}));
                }};
    }
};

/// Collective. The lines of a file of MEDIT's: keywords are headings.
inline std::unique_ptr<text_ranges> medit_text(const communicator& all, const std::filesystem::path& path)
{
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    return std::make_unique<text_ranges>(
        all, path, '#',
        [&](std::string_view line)
        {
            const tokens words(line, '#');
            return words.size() == 0 ? line_kind::nothing
                                     : (letter(words.word(0).front()) ? line_kind::heading : line_kind::item);
        });
}

/// Collective. MEDIT's files with an item a line, in double precision. Throws unsuited.
inline line_layout medit_lines(const communicator& all, const std::filesystem::path& path)
{
    line_layout layout;
    layout.first_number = 1;
    layout.texts.push_back(medit_text(all, path));
    const text_ranges& text = *layout.texts[0];
    const auto same = [](std::string_view a, std::string_view b) { return io::impl::same_letters(a, b); };
    std::int64_t version = 0, dimension = 0, meshes = 0;
    const auto& headings = text.headings();
    for (std::size_t k = 0; k < headings.size(); ++k)
    {
        const tokens words(headings[k].text, '#');
        const std::string_view keyword = words.word(0);
        if (same(keyword, "End")) break;
        std::int64_t begin = headings[k].at;
        const std::int64_t end = k + 1 < headings.size() ? headings[k + 1].at : text.items();
        const auto number = [&]
        {
            if (words.size() > 1) return words.integer(1);
            return tokens(text.lines(begin++, 1)[0], '#').integer(0);
        };
        const auto items = [&]
        {
            const std::int64_t count = number();
            if (count < 0 || count != end - begin) throw unsuited("it has not one item a line");
            return item_range{begin, count};
        };
        if (same(keyword, "MeshVersionFormatted")) version = number();
        if (same(keyword, "Dimension")) dimension = number();
        if (same(keyword, "Vertices"))
        {
            ++meshes;
            const auto range = items();
            layout.vertices = range.count;
            layout.sections.push_back({.what = line_section::content::vertices,
                                       .text = 0,
                                       .items = range,
                                       .group = [names = layout.groups.get()](const tokens& w)
                                       { return names->tagged("vertices", w.integer(3), 0); }});
        }
        if (const auto* section = medit_section::of(keyword))
            layout.sections.push_back(section->in(items(), *layout.groups));
    }
    if (version < 2 || dimension != 3 || meshes != 1)
        throw unsuited("it is not one mesh of three dimensions in double precision");
    return layout;
}

} // namespace taut::dist::impl
