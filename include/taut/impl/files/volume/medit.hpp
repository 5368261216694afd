// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/files/volume/builder.hpp>

namespace taut::io::impl
{

/// Reads MEDIT's .mesh: sections, each a keyword, a count and its items (Frey, "MEDIT: an interactive mesh
/// visualization software", INRIA RT-0253). Sections without vertices of cells are passed over.
class medit_reader
{
public:
    explicit medit_reader(volume_file& file) : to_(file), in_(to_.in()), from_(in_, {.comment = '#'}) {}

    void read()
    {
        in_.require_text();
        find_sections();
        read_points();
        to_.file().labels.push_back({"reference", true, {}});
        for (const auto& s : sections_) read_cells(s);
        to_.finish();
    }

private:
    struct section
    {
        std::string_view keyword;
        const char* content;
    };

    struct cell_section
    {
        std::string_view keyword;
        cell_kind kind;
        std::string_view group; ///< PREFIX of PREFIX:REFERENCE; empty: the items have no reference
    };

    static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

    void find_sections()
    {
        for (from_.skip(); !in_.done(); from_.skip())
        {
            const std::string_view word = in_.word();
            if (word.empty() || !is_letter(word.front())) continue;
            if (same_letters(word, "End")) return;
            sections_.push_back({word, in_.position()});
        }
    }

    bool go_to(std::string_view keyword)
    {
        const auto s = std::find_if(sections_.begin(), sections_.end(),
                                    [&](const section& any) { return same_letters(any.keyword, keyword); });
        if (s == sections_.end()) return false;
        in_.go_to(s->content);
        return true;
    }

    void read_points()
    {
        if (!go_to("MeshVersionFormatted"))
            in_.fail(
                "not a MEDIT mesh: there is no MeshVersionFormatted (.meshb, the binary form, is not read; convert "
                "it to .mesh)");
        const long long version = from_.integer(number_type::int64, "the version of the format");
        if (!go_to("Dimension")) in_.fail("no Dimension; give 2 or 3");
        const long long d = from_.integer(number_type::int64, "the dimension");
        if (d != 2 && d != 3) in_.fail("dimension " + std::to_string(d) + "; it must be 2 or 3");
        to_.set_places({}, version == 1, static_cast<int>(d));
        if (!go_to("Vertices")) in_.fail("no Vertices; a mesh needs some");
        const std::size_t n =
            from_.count(number_type::int64, "the number of vertices", static_cast<std::size_t>(2 * (d + 1)));
        to_.reserve_points(n);
        tagged_vertices groups;
        volume_label references{"reference", false, {}};
        for (std::size_t v = 0; v < n; ++v)
        {
            to_.add_point(from_);
            const auto vertex = static_cast<idx>(v);
            references.values.push_back(from_.integer(number_type::int64, "the reference of a vertex"));
            groups.add(references.values.back(), 0, {&vertex, 1});
        }
        to_.file().labels.push_back(std::move(references));
        groups.move_to_prefixed(to_.file(), "vertices");
    }

    void read_cells(const section& s)
    {
        static constexpr std::array<cell_section, 11> known = {{
            {"Edges", cell_kind::line, "edges"},
            {"Triangles", cell_kind::triangle, "triangles"},
            {"Quadrilaterals", cell_kind::quad, "quadrilaterals"},
            {"Tetrahedra", cell_kind::tetrahedron, "tetrahedra"},
            {"Pyramids", cell_kind::pyramid, "pyramids"},
            {"Prisms", cell_kind::wedge, "prisms"},
            {"Pentahedra", cell_kind::wedge, "prisms"},
            {"Hexahedra", cell_kind::hexahedron, "hexahedra"},
            {"Hexaedra", cell_kind::hexahedron, "hexahedra"},
            {"Corners", cell_kind::vertex, ""},
            {"RequiredVertices", cell_kind::vertex, ""},
        }};
        in_.go_to(s.content);
        const auto* found =
            std::find_if(known.begin(), known.end(), [&](const auto& k) { return same_letters(k.keyword, s.keyword); });
        if (found == known.end()) return require_first_order(s.keyword);
        const bool tagged = !found->group.empty();
        const auto corners = static_cast<std::size_t>(shape_of(found->kind).corners);
        const std::size_t n = from_.count(number_type::int64, "the number of cells", 2 * (corners + (tagged ? 1 : 0)));
        tagged_vertices groups;
        std::vector<idx> cell(corners);
        for (std::size_t c = 0; c < n; ++c)
        {
            for (idx& v : cell) v = to_.point_at(from_.integer(number_type::int64, "a vertex"), 1, from_);
            const long long reference = tagged ? from_.integer(number_type::int64, "the reference of a cell") : 0;
            groups.add(reference, shape_of(found->kind).dimension, cell);
            if (!tagged) continue;
            to_.add_cell(found->kind, cell);
            to_.file().labels.back().values.push_back(reference);
        }
        groups.move_to(to_.file(),
                       [&](long long reference)
                       {
                           return tagged ? std::string(found->group) + ':' + std::to_string(reference)
                                         : std::string(found->keyword == "Corners" ? "corners" : "required_vertices");
                       });
    }

    /// TrianglesP2, QuadrilateralsQ2, TetrahedraP3, ...
    void require_first_order(std::string_view keyword) const
    {
        const auto n = keyword.size();
        constexpr std::string_view orders = "PQpq";
        if (n > 2 && orders.find(keyword[n - 2]) != orders.npos && keyword[n - 1] >= '2' && keyword[n - 1] <= '9')
            in_.fail("cells of higher order (" + std::string(keyword.substr(0, 40)) +
                     "); save the mesh in first order");
    }

    volume_builder to_;
    scanner& in_;
    number_source from_;
    std::vector<section> sections_;
};

} // namespace taut::io::impl
