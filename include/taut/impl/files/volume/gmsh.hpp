// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/files/volume/builder.hpp>

namespace taut::io::impl
{

/// Common parts of all versions of gmsh's .msh: sections from $NAME to $EndNAME, names of physical groups, kinds of
/// elements (gmsh reference manual, "MSH file format").
class gmsh_sections
{
public:
    /// Throws io_error unless there are a format that is read, nodes and elements.
    explicit gmsh_sections(volume_builder& to) : to_(to), in_(to.in()), text_(in_, {})
    {
        find();
        read_format();
        read_names();
    }

    bool has(std::string_view section) const { return contents_.count(section) != 0; }

    /// Goes to the first byte of a section. Throws io_error if there is none.
    void go_to(std::string_view section)
    {
        const auto found = contents_.find(section);
        if (found == contents_.end()) in_.fail("no $" + std::string(section) + "; the mesh needs it");
        in_.go_to(found->second);
    }

    /// Throws io_error unless all of a section has been read.
    void leave(std::string_view section)
    {
        in_.skip_space();
        const char* const at = in_.position();
        if (in_.word() == "$End" + std::string(section)) return;
        in_.go_to(at);
        in_.fail("$" + std::string(section) + " does not end here, where its counts say; correct them");
    }

    bool version_4() const { return version_4_; }
    const number_encoding& encoding() const { return encoding_; }

    /// The kind of a type of elements. Throws io_error at `from` for one that is not read.
    static cell_kind kind_of(long long type, const number_source& from)
    {
        static constexpr std::array<std::pair<int, cell_kind>, 8> known = {{{15, cell_kind::vertex},
                                                                            {1, cell_kind::line},
                                                                            {2, cell_kind::triangle},
                                                                            {3, cell_kind::quad},
                                                                            {4, cell_kind::tetrahedron},
                                                                            {7, cell_kind::pyramid},
                                                                            {6, cell_kind::wedge},
                                                                            {5, cell_kind::hexahedron}}};
        for (const auto& [number, kind] : known)
            if (number == type) return kind;
        from.fail("element type " + std::to_string(type) +
                  " is not one of first order (points, lines, triangles, quads, tetrahedra, pyramids, prisms, "
                  "hexahedra); save with Mesh.ElementOrder = 1");
    }

    /// Notes the tags of the next cell, 0: none. A cell of several physical groups has the first of them.
    void add_tags(long long physical, long long entity)
    {
        tags_[0].push_back(physical);
        tags_[1].push_back(entity);
    }

    /// Notes that a cell belongs to a physical group, or to a geometric entity.
    void add_physical(int dimension, long long tag, std::span<const idx> corners)
    {
        physical_[static_cast<std::size_t>(dimension)].add(tag, dimension, corners);
    }
    void add_entity(int dimension, long long tag, std::span<const idx> corners)
    {
        entities_[static_cast<std::size_t>(dimension)].add(tag, dimension, corners);
    }

    /// Vertices of the cells of an entity, ascending, each once.
    std::vector<idx> vertices_of_entity(int dimension, long long tag) const
    {
        return entities_[static_cast<std::size_t>(dimension)].vertices_of(tag, to_.file().points.size());
    }

    /// Physical groups under their names, physical:DIM:TAG where they have none; in a file without them entity:DIM:TAG.
    void finish_groups()
    {
        to_.file().labels = {{"physical", true, std::move(tags_[0])}, {"entity", true, std::move(tags_[1])}};
        const bool physical =
            std::any_of(physical_.begin(), physical_.end(), [](const auto& groups) { return !groups.empty(); });
        for (int d = 0; d <= 3; ++d)
        {
            const auto k = static_cast<std::size_t>(d);
            if (!physical) entities_[k].move_to_prefixed(to_.file(), "entity:" + std::to_string(d));
            physical_[k].move_to(to_.file(),
                                 [&](long long tag)
                                 {
                                     const auto name = names_.find({d, tag});
                                     return name != names_.end()
                                                ? name->second
                                                : "physical:" + std::to_string(d) + ':' + std::to_string(tag);
                                 });
        }
    }

private:
    void find()
    {
        const std::string_view all(in_.start(),
                                   static_cast<std::size_t>(in_.position() - in_.start()) + in_.remaining());
        for (in_.skip_space(); !in_.done(); in_.skip_space())
        {
            const std::string_view word = in_.word();
            const char* const after = in_.position();
            in_.next_line();
            if (!word.starts_with('$')) continue; // a comment
            const std::string_view name = word.substr(1);
            if (name.size() > longest_name)
            {
                in_.go_to(word.data());
                in_.fail("the name of a section has " + std::to_string(name.size()) +
                         " letters; no section of gmsh has, the file is damaged, save it again");
            }
            const auto begin = static_cast<std::size_t>(in_.position() - in_.start());
            // Those of version 1 are $NOD to $ENDNOD, $ELM to $ENDELM.
            const bool first_version = name == "NOD" || name == "ELM";
            const auto end = all.find((first_version ? "$END" : "$End") + std::string(name), begin);
            if (end == all.npos)
            {
                in_.go_to(after);
                in_.fail("no $End" + std::string(name.substr(0, 40)) + " behind this; the file may have been cut off");
            }
            contents_.try_emplace(name, in_.position());
            in_.go_to(all.data() + end);
            in_.next_line();
        }
        in_.go_to(in_.start());
    }

    void read_format()
    {
        if (has("NOD"))
        {
            go_to("NOD");
            in_.fail("version 1 of the format is not read; save as 2.2 or 4.1 (gmsh -format msh41)");
        }
        if (!has("MeshFormat"))
            in_.fail("not a gmsh mesh of version 2 or 4: there is no $MeshFormat; save it with gmsh as 2.2 or 4.1");
        go_to("MeshFormat");
        const double version = in_.number();
        const long long binary = in_.integer("the type of the file"), size = in_.integer("the size of data");
        version_4_ = version == 4.1;
        if (!version_4_ && !(version >= 2 && version < 3))
        {
            go_to("MeshFormat");
            in_.fail("version " + std::string(in_.word().substr(0, 40)) +
                     " of the format is not read; save as 2.2 or 4.1 (gmsh -format msh41)");
        }
        if (size != 8) in_.fail("numbers of " + std::to_string(size) + " bytes; gmsh writes 8, save it so");
        if (binary == 0) return in_.require_text();
        encoding_.text = false;
        in_.next_line();
        const auto* const one = in_.bytes(4).data();
        for (const auto order : {std::endian::little, std::endian::big})
            if (load<std::int32_t>(one, order) == 1)
            {
                encoding_.order = order;
                return;
            }
        in_.fail(
            "the binary number 1 that tells the order of bytes is not there; the file may be damaged, save it again");
    }

    void read_names()
    {
        if (!has("PhysicalNames")) return;
        go_to("PhysicalNames");
        const std::size_t n = text_.count(number_type::int32, "the number of names");
        for (std::size_t k = 0; k < n; ++k)
        {
            const long long dimension = text_.integer(number_type::int32, "the dimension of a name");
            const long long tag = text_.integer(number_type::int32, "the tag of a name");
            std::string_view name = in_.rest_of_line();
            name = name.substr(0, name.find_last_not_of(" \t") + 1);
            if (name.size() > 1 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
            if (!name.empty()) names_[{dimension, tag}] = name;
        }
    }

    static constexpr std::size_t longest_name = 64; // its end is searched for

    volume_builder& to_;
    scanner& in_;
    number_source text_;
    number_encoding encoding_;
    bool version_4_ = false;
    std::map<std::string_view, const char*> contents_;
    std::map<std::pair<long long, long long>, std::string> names_;
    std::array<tagged_vertices, 4> physical_, entities_;
    std::array<std::vector<long long>, 2> tags_; ///< of cells: physical, entity
};

} // namespace taut::io::impl
