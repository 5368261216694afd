// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <taut/mesh.hpp>
#include <taut/paste.hpp>

namespace taut::impl
{

class face_set;

/// Cuts out triangles. Throws region_error unless they are a disk.
surface_region cut_out(const mesh<triangle>& m, const face_set& set);

/// Throws region_error unless they are from 0 to below `count`.
void require_in_range(std::span<const idx> ids, idx count, const char* thing, const char* things);

} // namespace taut::impl
