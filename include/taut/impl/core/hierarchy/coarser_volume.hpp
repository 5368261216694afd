// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/hierarchy/volume_thinning.hpp>

namespace taut::impl
{

/// Coarser volume mesh on some of the vertices.
struct coarser_volume
{
    std::vector<idx> vertices; ///< numbers in the mesh, ascending
    mesh<tetrahedron> volume;  ///< of these vertices; no cell is inverted
    std::vector<idx> into;     ///< of each vertex of the mesh the one of `volume` that it went into; -1 without cells
};

/// Coarsens a volume by half-edge collapses to a mesh whose boundary is the same surface, except for small features,
/// until it has `factor` times fewer vertices that are not kept, or no more can be removed.
///
/// m: no cell inverted, none overlapping another
/// kept: one flag per vertex, or none at all: a vertex with one is removed only where all of its neighbours have one
/// proceed: called between rounds; returning false ends them
///
/// Throws parameter_error. About 10 us per vertex.
inline coarser_volume make_coarser(const mesh<tetrahedron>& m, std::span<const char> kept = {}, double factor = 8,
                                   const std::function<bool()>& proceed = {})
{
    const std::size_t n = m.points().size();
    if (!kept.empty() && kept.size() != n) throw parameter_error("kept", "must have one flag a vertex, or none");
    if (!(factor >= 2)) throw parameter_error("factor", "must be at least 2");
    impl::volume_thinning thinning(m, kept);
    double left = double(kept.empty() ? n : static_cast<std::size_t>(std::count(kept.begin(), kept.end(), 0)));
    const double enough = left / factor;
    using rules = impl::volume_collapse_rules;
    for (const rules& r : {rules{.quality = 0.06, .facing = 0.9}, rules{.quality = 0.01, .facing = 0.7},
                           rules{.quality = 0.001, .facing = 0.5}})
        for (bool more = true; more && left > enough && (!proceed || proceed());)
        {
            const auto removed = static_cast<double>(thinning.round(r));
            left -= removed;
            more = removed > 0.03 * left;
        }
    auto into = thinning.into();
    std::vector<idx> vertices, number(n, -1);
    std::vector<vec3> points;
    for (std::size_t v = 0; v < n; ++v)
    {
        if (into[v] != static_cast<idx>(v)) continue;
        number[v] = static_cast<idx>(points.size());
        points.push_back(m.points()[v]);
        vertices.push_back(static_cast<idx>(v));
    }
    auto cells = thinning.cells();
    const auto renumber = [&](idx& v) { v = v < 0 ? -1 : number[static_cast<std::size_t>(v)]; };
    for (auto& t : cells) std::for_each(t.begin(), t.end(), renumber);
    std::for_each(into.begin(), into.end(), renumber);
    return {std::move(vertices), {std::move(points), std::move(cells)}, std::move(into)};
}

} // namespace taut::impl
