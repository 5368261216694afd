// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <taut/impl/files/gltf/source.hpp>
#include <taut/types.hpp>

/// Nodes that draw the meshes of a glTF document.
namespace taut::io::impl
{

/// Affine map of space.
struct gltf_transform
{
    mat3 linear = mat3(1.0);
    vec3 shift = vec3(0.0);

    vec3 operator()(const vec3& x) const { return linear * x + shift; }
    gltf_transform operator*(const gltf_transform& inner) const
    {
        return {linear * inner.linear, linear * inner.shift + shift};
    }

    /// Root of the mean square of the factors along the axes; the factor of a uniform scale.
    double scale() const
    {
        double square = 0;
        for (int k = 0; k < 3; ++k) square += glm::dot(linear[k], linear[k]);
        return std::sqrt(square / 3);
    }
};

/// A node of a scene that draws a mesh.
struct gltf_draw
{
    std::size_t node, mesh;
    std::size_t instances = 1; ///< of EXT_mesh_gpu_instancing
    gltf_transform place;      ///< from the mesh to the scene; of instances the largest one
    double least = 0;          ///< scale of the smallest one
};

/// The nodes that draw meshes in a scene, in the order of their numbers; without scenes all nodes count. A skin places
/// its mesh as its first joint does; animations and morphing are left aside.
/// Throws io_error for nodes that are not trees, invalid transforms, instances of different counts.
std::vector<gltf_draw> drawn_meshes(const gltf_source& source);

/// Triangles of the model that a primitive of another mesh, or with another material, draws, too.
struct gltf_copy
{
    std::size_t first, count;
    std::size_t owner; ///< the mesh that has them
    std::size_t mesh;  ///< the one that draws them as well
    idx material;      ///< with this; -1: none
};
std::vector<gltf_copy> copied_triangles(const gltf_source& source);

/// Gives each node that draws a mesh, but for the first, a copy of the mesh of its own, behind the others: with the
/// same accessors, until texture coordinates are written. Meshes that share triangles otherwise have their own, too.
/// Throws io_error where the copies are too many.
void part_meshes(gltf_source& source, std::span<const gltf_draw> draws);

} // namespace taut::io::impl
