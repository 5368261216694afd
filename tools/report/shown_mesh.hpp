// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include <taut/types.hpp>

namespace taut::report
{

/// A model and its atlas with the same triangles in both, as a page draws them.
struct shown_mesh
{
    std::vector<vec3> points;               ///< of the model
    std::vector<std::array<idx, 3>> cells;  ///< triangles of these points
    std::vector<vec2> places;               ///< of the atlas
    std::vector<std::array<idx, 3>> images; ///< the same triangles in the atlas
    std::vector<idx> origins;               ///< which triangle of the model each one is

    /// As it is: corners of one vertex that lie in one place of one chart are one there.
    shown_mesh(std::span<const vec3> model, std::span<const std::array<idx, 3>> triangles,
               std::span<const std::array<vec2, 3>> uv, std::span<const idx> chart);

    /// Moves vertices together until no more than `most` triangles are left, each of which keeps its chart. Vertices of
    /// one cube of a grid become one, places of one chart that edges join within a cube, too: charts stay apart, and
    /// the model has no gaps between them. For the eye alone: triangles may turn over.
    void simplify(idx most);
};

} // namespace taut::report
