// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/core/short_number.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/impl/core/untangle/proofs/infeasibility.hpp>
#include <taut/impl/core/untangle/proofs/pinned_outline.hpp>
#include <taut/impl/core/untangle/proofs/pinned_patches.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// The outline of a patch as edges in the order of its loops.
inline std::vector<std::array<idx, 2>> outline_edges(const mesh<triangle>& m, const facet_table& cut,
                                                     const pinned_patch& patch)
{
    std::vector<std::array<idx, 2>> edges;
    std::vector<idx> left = patch.outline; // ascending; a side that is taken becomes negative
    for (std::size_t k = 0; k < left.size(); ++k)
    {
        if (left[k] < 0) continue;
        idx side = patch.outline[k];
        do {
            edges.push_back(side_vertices(m, side));
            left[static_cast<std::size_t>(std::lower_bound(patch.outline.begin(), patch.outline.end(), side) -
                                          patch.outline.begin())] = -1;
            side = next_boundary_side(cut, side);
        } while (side != patch.outline[k]);
    }
    return edges;
}

/// Turning number of the outline, counted with the smallest angles that a surface can have at its vertices; nothing if
/// an edge has no length.
inline std::optional<long long> turning_number(const mesh<triangle>& m, const facet_table& cut,
                                               const pinned_patch& patch, std::span<const vec2> x)
{
    double sum = 0;
    for (const idx side : patch.outline)
    {
        const auto [a, b] = side_vertices(m, side);
        const idx c = side_vertices(m, next_boundary_side(cut, side))[1];
        sum += exterior_angle(x[static_cast<std::size_t>(a)], x[static_cast<std::size_t>(b)],
                              x[static_cast<std::size_t>(c)]);
    }
    if (std::isnan(sum)) return std::nullopt;
    return std::llround(sum / (2 * std::numbers::pi));
}

/// Finds patches that no map of positive elements has.
template <class Element>
void judge_patches(const untangle_problem<Element>& p, const facet_table& f, infeasibility& found)
{
    const auto cut = cut_at_pins(p, f);
    for (const auto& patch : pinned_patches(p, f, cut))
    {
        const auto prove = [&](infeasibility_kind kind, const auto& outline, const std::string& why)
        {
            constexpr bool plane = Element::dimension == 2;
            std::vector<idx> ids;
            for (const auto& facet : outline) // the first vertices of the edges name them all
                ids.insert(ids.end(), facet.begin(), plane ? facet.begin() + 1 : facet.end());
            found.prove(kind, std::move(ids),
                        [&](const auto& all)
                        {
                            return std::string(patch.boundary ? "the pinned boundary" : "a pinned outline") + " of " +
                                   (plane ? list_ids("vertex", "vertices", all) : list_ids("face", "faces", all, 3)) +
                                   " around " + std::to_string(patch.cells) + ' ' + Element::names + ' ' + why;
                        });
        };
        const std::span<const vec<Element::dimension>> x(p.initial);
        if constexpr (Element::dimension == 2)
        {
            const auto outline = outline_edges(p.rest, cut, patch);
            const auto area = enclosed<2>(outline, x);
            // Euler's characteristic of the patch, cut open.
            const idx chi = patch.interior + (static_cast<idx>(outline.size()) - patch.cells) / 2;
            if (area.sign <= 0)
            {
                prove(infeasibility_kind::outline_measure, outline,
                      "encloses the area " + short_number(area.det / 2) + "; turn or mirror its positions");
                continue;
            }
            const auto turns = turning_number(p.rest, cut, patch, x);
            if (turns && *turns < chi)
                prove(infeasibility_kind::outline_turning, outline,
                      "crosses itself: it turns " + std::to_string(*turns) + " times where " + std::to_string(chi) +
                          " is the least; undo the crossing");
            else if (const auto hole = find_negative_winding(outline, x))
                prove(infeasibility_kind::outline_winding, outline,
                      "crosses itself and runs the wrong way around (" + short_number(hole->point.x) + ", " +
                          short_number(hole->point.y) + "); undo the crossing");
        }
        else
        {
            std::vector<std::array<idx, 3>> outline;
            for (const idx side : patch.outline) outline.push_back(side_vertices(p.rest, side));
            const auto volume = enclosed<3>(outline, x);
            if (volume.sign <= 0)
                prove(infeasibility_kind::outline_measure, outline,
                      "encloses the volume " + short_number(volume.det / 6) + "; mirror its positions");
        }
    }
}

} // namespace taut::impl
