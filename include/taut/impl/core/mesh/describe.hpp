// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/errors.hpp>

namespace taut::impl
{

/// "1 triangle", "7 triangles"
std::string counted(std::size_t n, const std::string& thing, const std::string& things);

/// "7 triangles (3, 14, 15, 92, 65, ...)" of n, whose first ids are known.
std::string list_first_ids(const char* thing, const char* things, std::size_t n, const std::vector<idx>& ids,
                           std::size_t group = 1);

/// The same of all that are in a list; ids in groups of `group` are written "3-14".
inline std::string list_ids(const char* thing, const char* things, const std::vector<idx>& ids, std::size_t group = 1)
{
    return list_first_ids(thing, things, ids.size() / group, ids, group);
}

/// The first elements of n; where these are the corners of cells, "9 corners of cells (3, 14, ...)".
template <class Element>
std::string list_first_elements(std::size_t n, const std::vector<idx>& ids, std::span<const idx> owners)
{
    if (owners.empty()) return list_first_ids(Element::name, Element::names, n, ids);
    std::vector<idx> cells;
    for (const idx c : ids) cells.push_back(owners[static_cast<std::size_t>(c)]);
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    const std::size_t unseen = n - ids.size();
    const std::string text = list_first_ids("", "", cells.size() + unseen, cells);
    return counted(n, "corner", "corners") + (cells.size() == 1 && unseen == 0 ? " of cell " : " of cells ") +
           text.substr(text.find('('));
}

/// Describes unreferenced vertices, where they are no obstacle.
inline std::string describe_unused(const std::vector<idx>& ids)
{
    return list_ids("vertex", "vertices", ids) + " without a triangle: ignored";
}

/// Describes a fault of a mesh of `Element`s in a sentence: the count, the first ids, the fault and the remedy. owners:
/// where these are the corners of cells, the cell of each.
template <class Element>
mesh_finding describe(mesh_error::fault_type fault, std::vector<idx> ids, std::span<const idx> owners = {})
{
    const std::string cells = Element::names, facets = Element::facet_names;
    const auto of_cells = [&](std::size_t group = 1) { return list_ids(Element::name, Element::names, ids, group); };
    const auto pairs = [&] { return list_ids("pair", "pairs", ids, 2) + " of " + cells; };
    const auto vertices = [&] { return list_ids("vertex", "vertices", ids); };
    const auto say = [&]() -> std::string
    {
        switch (fault)
        {
        case mesh_error::empty:
            return "the mesh has no " + cells + "; give it at least one";
        case mesh_error::too_large:
            return "the mesh exceeds 32-bit numbering; split it";
        case mesh_error::index_out_of_range:
            return of_cells(2) + " naming a vertex that does not exist; repair the file";
        case mesh_error::non_finite:
            return vertices() + " with a coordinate that is not a finite number; repair the file";
        case mesh_error::repeated_vertex:
            return of_cells() + " naming a vertex twice; remove them";
        case mesh_error::degenerate_cell:
            return list_first_elements<Element>(ids.size(), ids, owners) +
                   " flat at rest; collapse an edge or move a vertex of each";
        case mesh_error::inverted_cell:
            return list_first_elements<Element>(ids.size(), ids, owners) +
                   " of negative rest volume; untangle the mesh, give a shape at rest, or swap two corners of each";
        case mesh_error::duplicate_cell:
            return pairs() + " with the same corners; remove one of each";
        case mesh_error::inconsistent_orientation:
            return pairs() + " oriented differently; turn one of each over, so that all agree";
        case mesh_error::not_orientable:
            return pairs() + " oriented differently, and no orientation agrees everywhere (one-sided, as a Moebius "
                             "strip); cut the mesh open along a seam";
        case mesh_error::non_manifold_facet:
            return list_ids(Element::facet_name, Element::facet_names, ids,
                            static_cast<std::size_t>(Element::dimension)) +
                   " with three or more " + cells + "; remove the extra ones or separate them";
        case mesh_error::non_manifold_vertex:
            return vertices() + " where parts touch that share no " + Element::facet_name + "; duplicate each vertex";
        case mesh_error::unreferenced_vertex:
            return vertices() + " without a " + Element::name + "; remove them";
        case mesh_error::several_components:
            return list_ids("component", "components, one vertex of each:", ids) + "; map them one at a time";
        case mesh_error::closed_surface:
            return "the surface has no boundary; cut it open along a seam";
        case mesh_error::several_boundaries:
            return list_ids("boundary loop", "boundary loops, one vertex of each:", ids) +
                   "; fill all but one, or cut from one to the next";
        case mesh_error::handles:
            return "the surface has handles and is not a disk; cut it open along a loop through each";
        }
        return "unknown fault";
    };
    std::string message = say();
    return {fault, std::move(ids), std::move(message)};
}

} // namespace taut::impl
