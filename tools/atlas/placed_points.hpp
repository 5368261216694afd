// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include <taut/impl/files/gltf/gltf.hpp>
#include <taut/mesh.hpp>

namespace taut::tools
{

/// The points of a surface where the nodes of a scene draw them, for lengths and angles are those of the scene. A mesh
/// that several nodes draw lies where it is largest; one that no node draws, as it is.
///
/// A node that mirrors is taken without that, so that fronts stay fronts. What a node would flatten is scaled in all
/// directions alike, and what would lose digits far from 0 is not moved.
///
/// meshes: the mesh of each triangle; points of different ones are different
/// notes:  gets what is as nobody may expect, in sentences
std::vector<vec3> placed_points(const mesh<triangle>& surface, std::span<const idx> meshes,
                                std::span<const io::impl::gltf_draw> draws, std::vector<std::string>& notes);

} // namespace taut::tools
