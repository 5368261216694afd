// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/files/volume/gmsh.hpp>

namespace taut::io::impl
{

/// Entities, nodes and elements of version 4.1: nodes and elements come in blocks, one per geometric entity, and it is
/// entities that physical groups name. Coordinates of entities (points of the geometry, boxes) are none of the mesh.
class gmsh4_reader
{
public:
    gmsh4_reader(volume_builder& to, gmsh_sections& sections)
        : to_(to), sections_(sections), from_(to.in(), sections.encoding())
    {
    }

    void read()
    {
        if (sections_.has("PartitionedEntities"))
        {
            sections_.go_to("PartitionedEntities");
            from_.fail("a mesh in partitions; save it without them (gmsh: Mesh > Unpartition)");
        }
        if (sections_.has("Entities"))
        {
            read_entities();
            sections_.leave("Entities");
        }
        read_nodes();
        sections_.leave("Nodes");
        read_elements();
        sections_.leave("Elements");
        add_physical_groups();
    }

private:
    static constexpr number_type integer = number_type::int32, size = number_type::uint64;
    static constexpr std::size_t most_times = 16;

    struct entity
    {
        int dimension;
        long long tag;
    };

    void read_entities()
    {
        sections_.go_to("Entities");
        std::array<std::size_t, 4> counts{};
        for (auto& n : counts) n = from_.count(size, "the number of entities");
        for (int d = 0; d <= 3; ++d)
            for (std::size_t k = 0; k < counts[static_cast<std::size_t>(d)]; ++k)
            {
                const long long tag = from_.integer(integer, "the tag of an entity");
                for (int i = 0; i < (d == 0 ? 3 : 6); ++i) from_.real(number_type::float64);
                auto& groups = physical_[{d, tag}];
                for (std::size_t n = from_.count(size, "the number of physical tags"); n > 0; --n)
                {
                    const long long physical = from_.integer(integer, "a physical tag");
                    groups.push_back(physical < 0 ? -physical : physical); // the sign is an orientation
                }
                if (d == 0) continue;
                for (std::size_t n = from_.count(size, "the number of bounding entities"); n > 0; --n)
                    from_.integer(integer, "the tag of an entity");
            }
    }

    entity read_entity()
    {
        const long long dimension = from_.integer(integer, "the dimension of an entity");
        if (dimension < 0 || dimension > 3)
            from_.fail("an entity of dimension " + std::to_string(dimension) + "; it must be 0 to 3");
        return {static_cast<int>(dimension), from_.integer(integer, "the tag of an entity")};
    }

    /// The numbers of blocks and of all items in them, and their least and greatest tag. The number of blocks.
    std::size_t read_block_counts()
    {
        const std::size_t blocks = from_.count(size, "the number of blocks");
        for (int k = 0; k < 3; ++k) from_.integer(size, "a count");
        return blocks;
    }

    void read_nodes()
    {
        sections_.go_to("Nodes");
        to_.set_places(sections_.encoding(), false, 3);
        for (std::size_t blocks = read_block_counts(); blocks > 0; --blocks)
        {
            const entity of = read_entity();
            const bool parametric = from_.integer(integer, "whether there are parameters") != 0;
            const std::size_t n = from_.count(size, "the number of nodes", from_.text() ? 8 : 32);
            for (std::size_t v = 0; v < n; ++v) to_.add_id(from_.integer(size, "the number of a node"));
            for (std::size_t v = 0; v < n; ++v)
            {
                to_.add_point(from_);
                for (int k = 0; parametric && k < of.dimension; ++k) from_.real(number_type::float64);
            }
        }
        to_.finish_ids(from_);
    }

    void read_elements()
    {
        sections_.go_to("Elements");
        for (std::size_t blocks = read_block_counts(); blocks > 0; --blocks)
        {
            const entity of = read_entity();
            const cell_kind kind = gmsh_sections::kind_of(from_.integer(integer, "the type of elements"), from_);
            const auto corners = static_cast<std::size_t>(shape_of(kind).corners);
            const std::size_t n = from_.count(size, "the number of elements", 2 * (corners + 1));
            const auto groups = physical_.find({of.dimension, of.tag});
            const bool physical = groups != physical_.end() && !groups->second.empty();
            std::vector<idx> cell(corners);
            for (std::size_t e = 0; e < n; ++e)
            {
                from_.integer(size, "the number of an element");
                for (idx& v : cell) v = to_.point_of_id(from_.integer(size, "a node"), from_);
                to_.add_cell(kind, cell);
                sections_.add_tags(physical ? groups->second.front() : 0, of.tag);
                sections_.add_entity(of.dimension, of.tag, cell);
            }
        }
    }

    /// Adds the vertices of entities to their physical groups. A tag takes few bytes of the file and stands for all
    /// vertices of the entity: there are no groups where these are many times what the mesh has.
    void add_physical_groups()
    {
        auto& file = to_.file();
        std::vector<std::vector<idx>> vertices;
        std::size_t named = 0;
        for (const auto& [of, tags] : physical_)
        {
            vertices.push_back(tags.empty() ? std::vector<idx>() : sections_.vertices_of_entity(of.first, of.second));
            named += tags.size() * vertices.back().size();
        }
        std::size_t there = file.points.size();
        for (const auto& block : file.cells) there += block.corners.size();
        if (named > most_times * there)
        {
            file.notes.push_back("the physical groups have more than " + std::to_string(most_times) +
                                 " times what the mesh has; no groups were made of them");
            return;
        }
        auto of_entity = vertices.begin();
        for (const auto& [of, tags] : physical_)
        {
            for (const long long tag : tags)
                if (!of_entity->empty()) sections_.add_physical(of.first, tag, *of_entity);
            ++of_entity;
        }
    }

    volume_builder& to_;
    gmsh_sections& sections_;
    number_source from_;
    std::map<std::pair<int, long long>, std::vector<long long>> physical_; ///< by dimension and tag of the entity
};

} // namespace taut::io::impl
