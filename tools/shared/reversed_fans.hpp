// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <taut/impl/files/surface/surface_file.hpp>
#include <taut/surface_file.hpp>

namespace taut::tools
{

/// Number of polygons that turn over where a program cuts them as fans, as many do: of the triangles from the first
/// corner one is not positive in a map, exactly. Convex polygons of a valid map are never among them.
/// at: where each corner of the faces is; none that is counted has a corner that is not a number
std::size_t count_reversed_fans(const io::impl::file_faces& faces, std::span<const vec2> at);

/// The same of a map of all triangles of a file, as cut along seams.
std::size_t count_reversed_fans(const io::impl::file_faces& faces, const mesh<triangle>& cut, std::span<const vec2> uv);

/// Tells of them, if there are some.
void note_reversed_fans(std::vector<std::string>& notes, std::size_t count);

} // namespace taut::tools
