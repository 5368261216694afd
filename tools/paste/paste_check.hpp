// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <taut/paste.hpp>

#include "shared/failure.hpp"
#include "shared/text_table.hpp"

/// Checks of a surface with a pasted feature before it is written, independent of the library's report.
namespace taut::tools
{

/// Throws no_valid_map unless it is manifold and has the boundary of the target, and unsuitable_input where that is not
/// manifold itself.
inline impl::seam_quality require_sound(const paste& p)
{
    const auto before = impl::measure_seam(p.target(), 0, 0);
    if (!before.manifold)
        throw unsuitable_input("the target is not manifold: at a vertex its triangles do not form one fan; `taut "
                               "check` lists such vertices, `taut atlas --repair` parts them");
    const auto quality = p.measure_seam();
    if (!quality.manifold || quality.boundary_edges != before.boundary_edges)
        throw no_valid_map("the pasted surface is not manifold, or has another boundary than the target; choose "
                           "another vertex, radius or scale");
    return quality;
}

/// Notes about it. meeting: pairs of triangles, as paste::self_intersections() finds them
inline std::vector<std::string> notes_of(const impl::seam_quality& quality,
                                         const std::vector<std::array<idx, 2>>& meeting)
{
    std::vector<std::string> notes;
    if (quality.folded > 0)
        notes.push_back(count(static_cast<std::uint64_t>(quality.folded), "edge", "edges") +
                        " of gap and feature where the surface turns back by more than 150 degrees");
    if (!meeting.empty())
        notes.push_back(count(meeting.size(), "new pair of triangles intersects", "new pairs of triangles intersect") +
                        ", such as " + std::to_string(meeting[0][0]) + " and " + std::to_string(meeting[0][1]) +
                        "; try another pose, scale or softness");
    return notes;
}

} // namespace taut::tools
