// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <taut/atlas.hpp>
#include <taut/impl/core/mesh/facets.hpp>

#include "atlas/atlas_source.hpp"

namespace taut::tools
{

/// Surfaces of several files as one, with points as they are placed.
struct joined_surfaces
{
    mesh<triangle> surface;
    std::vector<idx> first_cell, first_vertex; ///< #files + 1
};

joined_surfaces join(const std::vector<std::unique_ptr<atlas_source>>& sources);

/// Vertices of the joined surface as the files have them, ascending, each once; those of several files are counted on.
std::vector<idx> vertices_of_files(const std::vector<std::unique_ptr<atlas_source>>& sources,
                                   const joined_surfaces& joined, std::span<const idx> vertices);

/// The corners of all triangles in the order of the joined surface, as they lie in the atlas.
struct corner_maps
{
    corner_maps(const joined_surfaces& joined, const atlas& made);

    /// That of one file. It has the texture coordinates of its own triangles alone.
    corner_map of(std::size_t file) const;

private:
    struct part
    {
        std::vector<vec2> uv;
        std::vector<std::array<idx, 3>> cells;
    };
    std::vector<part> parts_;
};

/// All surfaces as triangles of one OBJ, an object each, which is named as its file; points are as in the files.
void write_joined(io::atomic_file& out, std::span<const std::string> names,
                  const std::vector<std::unique_ptr<atlas_source>>& sources, const joined_surfaces& joined,
                  const corner_maps& maps);

} // namespace taut::tools
