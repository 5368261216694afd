// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <vector>

#include <taut/mesh.hpp>

namespace taut::impl
{

/// Map of a long tube on concentric rings, or nothing where the surface is none. A barycentric map shrinks a tube by
/// exp(2 pi) for each circumference of its length; rings whose radii grow as the length along it keep its energy near
/// 7 times the length by the mean circumference.
///
/// Rings and rays are those of the harmonic functions of the surface from the outline to the hole that is farthest from
/// it, and around that; other holes are filled. Where the rings of corners cross, as on irregular triangles, each
/// vertex is put at a mean of its neighbours with the weights of these places, which is injective (Floater 2003).
///
/// loops: the boundary loops of m. The scale is near that of the least isometric energy. It is for the caller to
/// certify. Throws `error`, elimination_solver::stopped.
std::vector<vec2> tube_map(const mesh<triangle>& m, std::span<const std::vector<idx>> loops,
                           const std::function<bool()>& proceed = {});

} // namespace taut::impl
