// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <taut/impl/dist/ranges/line_layout.hpp>

namespace taut::dist::impl
{

/// Kinds of VTK, which are SU2's. Throws unsuited.
inline io::cell_kind kind_of_vtk(std::int64_t type)
{
    switch (type)
    {
    case 1:
        return io::cell_kind::vertex;
    case 3:
        return io::cell_kind::line;
    case 5:
        return io::cell_kind::triangle;
    case 9:
        return io::cell_kind::quad;
    case 10:
        return io::cell_kind::tetrahedron;
    case 12:
        return io::cell_kind::hexahedron;
    case 13:
        return io::cell_kind::wedge;
    case 14:
        return io::cell_kind::pyramid;
    default:
        throw unsuited("it has cells of a kind that is not read by ranges");
    }
}

/// Collective. SU2's files of one zone: lines KEY= VALUE, behind some of which items follow. Throws unsuited.
inline line_layout su2_lines(const communicator& all, const std::filesystem::path& path)
{
    const auto before_comment = [](std::string_view line) { return line.substr(0, line.find('%')); };
    line_layout layout;
    layout.texts.push_back(std::make_unique<text_ranges>(all, path, '%',
                                                         [&](std::string_view line)
                                                         {
                                                             if (before_comment(line).find('=') != line.npos)
                                                                 return line_kind::heading;
                                                             return blank_or(line, '%', line_kind::item);
                                                         }));
    struct entry
    {
        std::string name;
        std::string value;
        std::int64_t at;
        std::int64_t number() const { return tokens(value).integer(0); }
    };
    std::vector<entry> entries;
    for (const auto& h : layout.texts[0]->headings())
    {
        const auto text = before_comment(h.text);
        const auto equals = text.find('=');
        const tokens name(text.substr(0, equals));
        entries.push_back({std::string(name.word(0)), std::string(text.substr(equals + 1)), h.at});
    }
    std::int64_t dimension = 0, elements = 0, points = 0;
    for (std::size_t k = 0; k < entries.size(); ++k)
    {
        const entry& e = entries[k];
        const std::int64_t end = k + 1 < entries.size() ? entries[k + 1].at : layout.texts[0]->items();
        const auto range = [&](const entry& with_count)
        {
            const item_range items{with_count.at, with_count.number()};
            if (items.count < 0 || items.count > end - with_count.at) throw unsuited("a section is too short");
            return items;
        };
        if (e.name == "NZONE" || e.name == "IZONE" || e.name == "SEND_RECV") throw unsuited("it has zones or parts");
        if (e.name == "NDIME") dimension = e.number();
        if (e.name == "NPOIN")
        {
            ++points;
            const auto items = range(e);
            layout.vertices = items.count;
            layout.sections.push_back({line_section::content::vertices, 0, items});
        }
        if (e.name != "NELEM" && e.name != "MARKER_ELEMS") continue;
        const bool marker = e.name == "MARKER_ELEMS";
        if (!marker) ++elements;
        if (marker && (k == 0 || entries[k - 1].name != "MARKER_TAG")) throw unsuited("a marker has no name");
        std::string name;
        if (marker) name = tokens(entries[k - 1].value).word(0);
        if (name == "SEND_RECEIVE") throw unsuited("it has zones or parts");
        layout.sections.push_back({.what = line_section::content::cells,
                                   .text = 0,
                                   .items = range(e),
                                   .cell = [name, label = marker ? static_cast<std::int64_t>(k) : 0,
                                            names = layout.groups.get()](const tokens& words, line_cell& c)
                                   {
                                       c.kind = kind_of_vtk(words.integer(0));
                                       c.take(words, 1);
                                       c.labels[0] = label;
                                       if (!name.empty())
                                           c.groups.push_back(names->number({name, c.dimension(), false}));
                                   }});
    }
    if (dimension != 3 || elements != 1 || points != 1) throw unsuited("it is not one mesh of three dimensions");
    return layout;
}

} // namespace taut::dist::impl
