// SPDX-License-Identifier: MIT
#pragma once

#include <taut/atlas.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Requirements of make_atlas() on a surface.
inline constexpr mesh_requirements atlas_requirements{
    .referenced = false, .connected = false, .open = false, .one_boundary = false, .no_handles = false};

} // namespace taut::impl
