// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/charts/repair/repair_finding.hpp>
#include <taut/impl/core/mesh/describe.hpp>
#include <taut/repair.hpp>

namespace taut::impl
{

/// Describes a finding in a sentence.
inline repair_finding describe_finding(repair_kind kind, std::vector<idx> ids)
{
    const auto list = [&](const char* thing, const char* things, const char* what)
    { return list_ids(thing, things, ids, static_cast<std::size_t>(ids_each(kind))) + ' ' + what; };
    const auto say = [&]() -> std::pair<std::string, std::string>
    {
        switch (kind)
        {
        case repair_kind::index_out_of_range:
            return {list("triangle", "triangles", "naming a vertex that does not exist"), "left out"};
        case repair_kind::non_finite:
            return {list("vertex", "vertices", "with a coordinate that is not a finite number"),
                    "left out with their triangles"};
        case repair_kind::repeated_vertex:
            return {list("triangle", "triangles", "naming a vertex twice"), "left out"};
        case repair_kind::degenerate_cell:
            return {list("triangle", "triangles", "flat at rest"), "left out"};
        case repair_kind::duplicate_cell:
            return {list("pair", "pairs", "of triangles that are the same"), "the second of each left out"};
        case repair_kind::unreferenced_vertex:
            return {list("vertex", "vertices", "without a triangle"), "left out"};
        case repair_kind::coincident_vertex:
            return {list("pair", "pairs", "of vertices at one place, where open edges meet"), "welded"};
        case repair_kind::inconsistent_orientation:
            return {list("triangle", "triangles", "oriented differently than others"), "turned over"};
        case repair_kind::not_orientable:
            return {list("edge", "edges", "where no orientation agrees (one-sided, as a Moebius strip)"), "cut open"};
        case repair_kind::non_manifold_facet:
            return {list("edge", "edges", "with three or more triangles"),
                    "parted; of triangles that face the same way, the pairs that bend least stay together"};
        case repair_kind::non_manifold_vertex:
            return {list("vertex", "vertices", "where parts touch that share no edge"), "one made for each part"};
        case repair_kind::contradicting_normal:
            return {list("triangle", "triangles", "facing away from the normals at all corners"),
                    "left as they are; turn them over, or the normals"};
        }
        return {};
    };
    auto [problem, action] = say();
    return {kind, std::move(ids), std::move(problem), std::move(action)};
}

} // namespace taut::impl
