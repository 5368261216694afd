// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <taut/repair.hpp>

namespace taut::impl
{

/// Counts the open edges that repair_surface() would stitch with this tolerance. bodies: as repair_params has them
std::size_t count_near_edges(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles,
                             double weld_tolerance, std::span<const idx> bodies = {});

} // namespace taut::impl
