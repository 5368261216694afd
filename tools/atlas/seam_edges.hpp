// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include <taut/impl/core/mesh/facets.hpp>

#include "atlas/atlas_options.hpp"
#include "atlas/joined_surfaces.hpp"

namespace taut::tools
{

/// The seams that the options ask for, one flag a side of the joined surface, whose facets are `f`; empty if there are
/// none. densities: of its triangles, or none; seams part those that differ. Throws io_error, unsuitable_input.
std::vector<char> seams_of(const std::vector<std::unique_ptr<atlas_source>>& sources, const joined_surfaces& joined,
                           const impl::facet_table& f, const atlas_options& options, std::span<const double> densities);

/// Factors of what seams cost along each side: those of the file of weights, and less between materials where there is
/// an angle of creases; empty if there are none. Throws io_error, unsuitable_input.
std::vector<double> seam_weights_of(const std::vector<std::unique_ptr<atlas_source>>& sources,
                                    const joined_surfaces& joined, const impl::facet_table& f,
                                    const atlas_options& options);

/// The edges between triangles of one polygon, one flag a side; empty if all faces are triangles.
std::vector<char> diagonals_of(const std::vector<std::unique_ptr<atlas_source>>& sources, const impl::facet_table& f);

/// The texture coordinates of all files, one per corner of the joined surface.
/// Throws unsuitable_input if a file has none, io::texcoord_error if a corner has none.
std::vector<std::array<vec2, 3>> texcoords_of(const std::vector<std::unique_ptr<atlas_source>>& sources);

/// The tile of each triangle of a file, one for each of its materials. Throws unsuitable_input where it has none.
std::vector<idx> tiles_by_material(const atlas_source& source);

} // namespace taut::tools
