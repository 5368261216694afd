// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <taut/elements.hpp>
#include <taut/impl/core/mesh/incidence.hpp>

namespace taut::impl
{

/// Record of the coarsening of a level, from which vertices are reinserted; specialised by element. Empty for volumes
/// and hinges, whose coarser levels have no cells to insert vertices into.
template <class Element>
struct removals
{
};

/// Record for surfaces: half-edge collapses in rounds. In a round no two removed vertices are neighbours, so all of it
/// can be done, and undone, at once. Numbers are those of the finer level.
template <>
struct removals<triangle>
{
    std::vector<idx> vertex; ///< the removed vertices, ascending in each round
    std::vector<idx> target; ///< position in the ring of the neighbour that it was pulled into
    std::vector<char> open;  ///< it is on the boundary: its ring starts and ends along the boundary
    csr rings;               ///< neighbours of each when it was removed, counter-clockwise: triangles (v, r[i], r[i+1])
    std::vector<idx> rounds; ///< round r: removals rounds[r] .. rounds[r + 1] - 1

    std::size_t round_count() const { return rounds.size() - 1; }
};

} // namespace taut::impl
