// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <taut/impl/files/volume/gmsh.hpp>

namespace taut::io::impl
{

/// Nodes and elements of version 2: numbers of any order, with gaps; tags of an element: physical group, entity,
/// partitions. In binary files elements of one type come in runs with a header.
class gmsh2_reader
{
public:
    gmsh2_reader(volume_builder& to, gmsh_sections& sections)
        : to_(to), sections_(sections), from_(to.in(), sections.encoding())
    {
    }

    void read()
    {
        const char* const nodes = sections_.has("ParametricNodes") ? "ParametricNodes" : "Nodes";
        read_nodes(nodes);
        sections_.leave(nodes);
        read_elements();
        sections_.leave("Elements");
    }

private:
    static constexpr number_type integer = number_type::int32;

    /// A count, which stands as text in binary files, too.
    std::size_t read_count(const char* what)
    {
        const std::size_t n = number_source(to_.in(), {}).count(number_type::int64, what);
        to_.in().next_line();
        return n;
    }

    /// Parametric nodes have the dimension and the tag of an entity behind them, and parameters on lines and faces.
    void read_nodes(std::string_view section)
    {
        sections_.go_to(section);
        const std::size_t n = read_count("the number of nodes");
        to_.set_places(sections_.encoding(), false, 3);
        from_.fitting(static_cast<long long>(n), "the number of nodes", from_.text() ? 8 : 28);
        to_.reserve_points(n);
        for (std::size_t v = 0; v < n; ++v)
        {
            to_.add_id(from_.integer(integer, "the number of a node"));
            to_.add_point(from_);
            if (section == "Nodes") continue;
            const long long dimension = from_.integer(integer, "the dimension of an entity");
            from_.integer(integer, "the tag of an entity");
            for (long long k = 0; k < dimension && dimension < 3; ++k) from_.real(number_type::float64);
        }
        to_.finish_ids(from_);
    }

    void read_elements()
    {
        sections_.go_to("Elements");
        const std::size_t n = read_count("the number of elements");
        for (std::size_t e = 0; e < n;)
        {
            const bool text = from_.text();
            if (text) from_.integer(integer, "the number of an element");
            const cell_kind kind = gmsh_sections::kind_of(from_.integer(integer, "the type of an element"), from_);
            const long long run = text ? 1 : from_.integer(integer, "the number of elements of this type");
            const long long tags = from_.integer(integer, "the number of tags");
            if (run < 1 || tags < 0 || run > static_cast<long long>(n - e))
                from_.fail("a run of " + std::to_string(run) + " elements with " + std::to_string(tags) +
                           " tags; the file is damaged, save it again");
            for (long long k = 0; k < run; ++k, ++e)
            {
                if (!text) from_.integer(integer, "the number of an element");
                read_element(kind, tags);
            }
        }
    }

    void read_element(cell_kind kind, long long tags)
    {
        long long physical = 0, entity = 0;
        for (long long k = 0; k < tags; ++k)
        {
            const long long tag = from_.integer(integer, "a tag");
            if (k == 0) physical = tag;
            if (k == 1) entity = tag;
            if (k == 2 && tags > 3 && tag > 0)
                from_.fail("a mesh in partitions; save it without them (gmsh: Mesh > Unpartition)");
        }
        std::array<idx, 8> corners{};
        const auto cell = std::span(corners).first(static_cast<std::size_t>(shape_of(kind).corners));
        for (idx& v : cell) v = to_.point_of_id(from_.integer(integer, "a node"), from_);
        to_.add_cell(kind, cell);
        sections_.add_tags(physical, entity);
        if (physical != 0) sections_.add_physical(shape_of(kind).dimension, physical, cell);
        if (entity != 0) sections_.add_entity(shape_of(kind).dimension, entity, cell);
    }

    volume_builder& to_;
    gmsh_sections& sections_;
    number_source from_;
};

} // namespace taut::io::impl
