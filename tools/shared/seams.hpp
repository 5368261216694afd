// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>

#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>
#include <taut/surface_file.hpp>
#include <vector>

namespace taut::tools
{

/// The surface of a file cut open along the seams of its texture coordinates, if it has seams and is not as needed
/// without, or if that is `wanted`; else nothing. What cutting does not mend stays for validate().
/// Throws unsuitable_input where the cut leaves anything but one piece of the required topology, and io::texcoord_error
/// if a cut is wanted and a corner has no texture coordinate.
std::optional<io::cut_surface> cut_open(const io::surface_file& file, mesh_requirements need, bool wanted);

/// The surface of a file cut open along seams that make it one disk; nothing if it is one.
/// Throws mesh_error (no oriented manifold, several components), unsuitable_input (a seam through a polygon).
std::optional<io::cut_surface> cut_to_one_disk(const io::surface_file& file);

/// "cut open along the seams of its vt, on which 14 vertices lie"
std::string describe(const io::cut_surface& cut);

/// The vertices of the file that a cut divides, ascending, as often as it adds one.
std::vector<idx> divided_vertices(const io::cut_surface& cut);

/// Throws unsuitable_input if a pin names one of them.
void require_undivided(std::span<const io::pin<2>> pins, std::span<const idx> divided);

} // namespace taut::tools
