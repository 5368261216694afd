// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/impl/core/constrain/boundary_slides.hpp>
#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/mesh/describe.hpp>
#include <taut/impl/files/volume/volume_file_bodies.hpp>
#include <taut/volume_file.hpp>

namespace taut::io::impl
{

/// Side of a cell of the file's dimension: a face, its normal pointing out where the cell is positive, or in the plane
/// an edge, with the cell to its left.
struct cell_face
{
    idx cell;                    ///< as for_each_cell() counts
    std::array<idx, 4> vertices; ///< around; -1 behind the last

    std::span<const idx> corners() const
    {
        return std::span<const idx>(vertices).first(vertices[2] < 0 ? 2 : vertices[3] < 0 ? 3 : 4);
    }
};

/// Faces of all cells of the file's dimension, in the order of the cells, and their adjacency.
struct cell_faces
{
    static constexpr idx boundary = -1;     ///< no cell is on the other side
    static constexpr idx non_manifold = -2; ///< three cells or more share the face

    std::vector<impl::cell_face> faces;
    std::vector<idx> twin; ///< the other side of each, or boundary, or non_manifold

    /// Returns whether a side goes around as its twin does: one of the two cells has its corners in the other order.
    bool clashes(std::size_t side) const
    {
        if (twin[side] < 0) return false;
        const auto here = faces[side].corners(), there = faces[static_cast<std::size_t>(twin[side])].corners();
        if (here.size() == 2) return here[0] == there[0];
        const auto at = std::find(there.begin(), there.end(), here[0]) - there.begin();
        return here[1] == there[static_cast<std::size_t>(at + 1) % there.size()];
    }
};

/// Corners of the sides of a cell, by VTK's numbers; -1 behind the last.
inline std::span<const std::array<int, 4>> face_table(cell_kind kind)
{
    using face = std::array<int, 4>;
    static constexpr std::array<face, 3> triangle = {{{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 0, -1, -1}}};
    static constexpr std::array<face, 4> quad = {{{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 3, -1, -1}, {3, 0, -1, -1}}};
    static constexpr std::array<face, 4> tetrahedron = {{{1, 2, 3, -1}, {0, 3, 2, -1}, {0, 1, 3, -1}, {0, 2, 1, -1}}};
    static constexpr std::array<face, 5> pyramid = {
        {{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}}};
    static constexpr std::array<face, 5> wedge = {
        {{0, 1, 2, -1}, {3, 5, 4, -1}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}}};
    static constexpr std::array<face, 6> hexahedron = {
        {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
    switch (kind)
    {
    case cell_kind::triangle:
        return triangle;
    case cell_kind::quad:
        return quad;
    case cell_kind::tetrahedron:
        return tetrahedron;
    case cell_kind::pyramid:
        return pyramid;
    case cell_kind::wedge:
        return wedge;
    case cell_kind::hexahedron:
        return hexahedron;
    default:
        return {};
    }
}

} // namespace taut::io::impl

namespace taut::io
{

inline impl::cell_faces volume_file::faces() const
{
    std::size_t n = 0;
    for (const auto& block : cells)
        if (impl::shape_of(block.kind).dimension == dimension) n += block.size() * impl::face_table(block.kind).size();
    impl::cell_faces result;
    result.faces.reserve(n);
    impl::for_each_cell(*this, dimension,
                        [&](cell_kind kind, idx number, std::span<const idx> corners)
                        {
                            for (const auto& side : impl::face_table(kind))
                            {
                                auto& face = result.faces.emplace_back(impl::cell_face{number, {-1, -1, -1, -1}});
                                for (std::size_t k = 0; k < 4; ++k)
                                    if (side[k] >= 0) face.vertices[k] = corners[static_cast<std::size_t>(side[k])];
                            }
                        });

    struct entry
    {
        std::uint64_t others; // the two largest corners
        idx between, side;    // of a quad the corner between them and the smallest, else -1

        bool same(const entry& e) const { return others == e.others && between == e.between; }
        bool operator<(const entry& e) const
        {
            return std::tie(others, between, side) < std::tie(e.others, e.between, e.side);
        }
    };
    std::vector<entry> order(n);
    const auto smallest = [&](std::size_t side)
    {
        const auto corners = result.faces[side].corners();
        return *std::min_element(corners.begin(), corners.end());
    };
    const auto start = taut::impl::counting_sort(
        n, points.size(), smallest,
        [&](std::size_t side, std::size_t position)
        {
            auto key = result.faces[side].vertices; // -1 in front when sorted: the smallest corner is left out below
            std::sort(key.begin(), key.end());
            const bool quad = key[0] >= 0;
            const idx low = key[1] >= 0 ? key[2] : -1; // of an edge in the plane there is one other corner
            order[position] = {(static_cast<std::uint64_t>(static_cast<std::uint32_t>(low)) << 32) |
                                   static_cast<std::uint32_t>(key[3]),
                               quad ? key[1] : -1, static_cast<idx>(side)};
        });
    taut::impl::parallel_for(points.size(),
                             [&](std::size_t begin, std::size_t end)
                             {
                                 for (std::size_t v = begin; v < end; ++v)
                                     std::sort(order.begin() + start[v], order.begin() + start[v + 1]);
                             });
    result.twin.assign(n, impl::cell_faces::boundary);
    for (std::size_t v = 0; v < points.size(); ++v)
        for (auto first = static_cast<std::size_t>(start[v]), last = first,
                  end = static_cast<std::size_t>(start[v + 1]);
             first < end; first = last)
        {
            while (last < end && order[last].same(order[first])) ++last;
            if (last - first == 1) continue;
            for (std::size_t k = first; k < last; ++k)
                result.twin[static_cast<std::size_t>(order[k].side)] =
                    last - first > 2 ? impl::cell_faces::non_manifold : order[k == first ? last - 1 : first].side;
        }
    return result;
}

} // namespace taut::io

namespace taut::io::impl
{

/// Labels of the cells of a file as numbers, 0: none. For gmsh files these are physical groups or else entities, for
/// VTK integer arrays that do not number single cells.
inline std::vector<idx> region_numbers(const volume_file& file)
{
    std::size_t cells = 0;
    for (const auto& block : file.cells) cells += block.size();
    std::vector<const volume_label*> labels;
    for (const auto& label : file.labels)
    {
        const std::set<long long> values(label.values.begin(), label.values.end());
        const bool many = (file.format == "VTK" || file.format == "VTU") &&
                          (values.size() > 256 || (values.size() > 16 && 2 * values.size() > label.values.size()));
        if (!label.of_cells || label.values.size() != cells || many || values == std::set<long long>{0}) continue;
        labels.push_back(&label);
        if (label.name == "physical") break;
    }
    std::vector<idx> numbers(cells, 0);
    std::map<std::vector<long long>, idx> known{{std::vector<long long>(labels.size(), 0), 0}};
    for (std::size_t c = 0; c < cells && !labels.empty(); ++c)
    {
        std::vector<long long> values;
        for (const auto* label : labels) values.push_back(label->values[c]);
        numbers[c] = known.try_emplace(std::move(values), static_cast<idx>(known.size())).first->second;
    }
    return numbers;
}

} // namespace taut::io::impl

namespace taut::io
{

inline std::vector<taut::impl::kept_facet> volume_file::kept_facets(bool boundary) const
{
    const auto numbers = impl::region_numbers(*this);
    const auto key_of = [](std::span<const idx> corners)
    {
        std::array<idx, 4> key{-1, -1, -1, -1};
        std::copy(corners.begin(), corners.end(), key.begin());
        std::sort(key.begin(), key.end());
        return key;
    };
    std::vector<idx> regions;
    std::map<std::array<idx, 4>, idx> labels_of_faces;
    std::size_t number = 0;
    for (const auto& block : cells)
        for (std::size_t c = 0; c < block.size(); ++c, ++number)
            if (impl::shape_of(block.kind).dimension == dimension)
                regions.push_back(numbers[number]);
            else if (impl::shape_of(block.kind).dimension == dimension - 1)
            {
                auto& label = labels_of_faces[key_of(block.cell(c))]; // of copies, that of one that has any
                label = label == 0 ? numbers[number] : label;
            }

    const auto sides = this->faces();
    std::vector<taut::impl::kept_facet> kept;
    std::map<std::array<idx, 3>, idx> pieces;
    for (std::size_t s = 0; s < sides.faces.size(); ++s)
    {
        const auto& side = sides.faces[s];
        const idx twin = sides.twin[s];
        if (twin < 0 ? !boundary || twin == impl::cell_faces::non_manifold : twin < static_cast<idx>(s)) continue;
        const auto face = labels_of_faces.find(key_of(side.corners()));
        const idx label = face != labels_of_faces.end() ? face->second : 0;
        const idx here = regions[static_cast<std::size_t>(side.cell)];
        const idx there =
            twin < 0 ? -1 : regions[static_cast<std::size_t>(sides.faces[static_cast<std::size_t>(twin)].cell)];
        if (here == there && label == 0) continue;
        const auto piece =
            pieces.try_emplace({label, std::min(here, there), std::max(here, there)}, static_cast<idx>(pieces.size()));
        kept.push_back({side.vertices, piece.first->second});
    }
    return kept;
}

} // namespace taut::io

namespace taut::io::impl
{

/// Finds faults of the cells of a file, because of which they cannot all be positive and disjoint: pairs with the same
/// corners (duplicate_cell), neighbours oriented differently (inconsistent_orientation), and sides that three cells or
/// more share (non_manifold_facet), each with all of its kind. Cells count as for_each_cell() does.
inline std::vector<taut::mesh_finding> check_sides(const volume_file& file)
{
    const auto sides = file.faces();
    const auto twin_cell = [&](std::size_t s) { return sides.faces[static_cast<std::size_t>(sides.twin[s])].cell; };
    std::vector<idx> copies, clashing, non_manifold;
    std::vector<std::array<idx, 4>> told;
    for (std::size_t first = 0, last = 0; first < sides.faces.size(); first = last)
    {
        const idx cell = sides.faces[first].cell;
        bool copy = true;
        for (; last < sides.faces.size() && sides.faces[last].cell == cell; ++last)
            copy = copy && sides.twin[last] >= 0 && twin_cell(last) == twin_cell(first);
        if (copy && cell < twin_cell(first)) copies.insert(copies.end(), {cell, twin_cell(first)});
        for (std::size_t s = first; s < last; ++s)
        {
            if (!copy && sides.twin[s] > static_cast<idx>(s) && sides.clashes(s))
                clashing.insert(clashing.end(), {cell, twin_cell(s)});
            if (sides.twin[s] != cell_faces::non_manifold) continue;
            told.push_back(sides.faces[s].vertices);
            const auto corners = sides.faces[s].corners().size();
            std::sort(told.back().begin(), told.back().begin() + static_cast<std::ptrdiff_t>(corners));
        }
    }
    std::sort(told.begin(), told.end());
    told.erase(std::unique(told.begin(), told.end()), told.end());
    const std::size_t named = file.dimension == 2 ? 2 : 3; // three corners of a quad say which one it is
    for (const auto& face : told)
        non_manifold.insert(non_manifold.end(), face.begin(), face.begin() + static_cast<std::ptrdiff_t>(named));

    const auto pairs = [](const std::vector<idx>& ids) { return taut::impl::list_ids("pair", "pairs", ids, 2); };
    std::vector<taut::mesh_finding> found;
    if (!copies.empty())
        found.push_back({mesh_error::duplicate_cell, copies,
                         pairs(copies) + " of cells with the same corners; remove one of each"});
    if (!clashing.empty())
        found.push_back({mesh_error::inconsistent_orientation, clashing,
                         pairs(clashing) +
                             " of cells oriented differently, in whatever order their corners are; cut the "
                             "mesh open there, or remove cells"});
    if (!non_manifold.empty())
        found.push_back({mesh_error::non_manifold_facet, non_manifold,
                         (named == 2 ? taut::impl::list_ids("edge", "edges", non_manifold, named)
                                     : taut::impl::list_ids("face", "faces", non_manifold, named)) +
                             " with three or more cells; remove the extra ones or separate them"});
    return found;
}

} // namespace taut::io::impl
