// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/mesh.hpp>

namespace taut::impl
{

/// Rank of each vertex of a volume, the number of directions that the normals of its boundary faces span: 0 inside, 1
/// on a smooth part of the boundary, 2 on a crease, 3 in a corner. After the classes of Adams, "Parallel multigrid
/// solvers for 3D unstructured finite element problems".
///
/// faces: of the boundary; unit: a power of two that brings lengths near 1
inline std::vector<char> boundary_rank(const mesh<tetrahedron>& m, std::span<const std::array<idx, 3>> faces,
                                       double unit)
{
    // Of each vertex the sum of n n' / |n| over its boundary faces, n twice the area: symmetric, by (i, j), i <= j.
    struct tensor
    {
        double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
    };
    std::vector<tensor> sums(m.points().size());
    for (const auto& face : faces)
    {
        const auto at = [&](std::size_t k) { return unit * m.points()[static_cast<std::size_t>(face[k])]; };
        const vec3 n = glm::cross(at(1) - at(0), at(2) - at(0));
        const double area = glm::length(n);
        if (!(area > 0)) continue;
        for (const idx v : face)
        {
            tensor& t = sums[static_cast<std::size_t>(v)];
            t.xx += n.x * n.x / area;
            t.xy += n.x * n.y / area;
            t.xz += n.x * n.z / area;
            t.yy += n.y * n.y / area;
            t.yz += n.y * n.z / area;
            t.zz += n.z * n.z / area;
        }
    }
    std::vector<char> rank(sums.size(), 0);
    for (std::size_t v = 0; v < rank.size(); ++v)
    {
        // With eigenvalues l1 >= l2 >= l3 the invariants say l2 / l1 and l3 / l1 nearly enough.
        const tensor& t = sums[v];
        const double first = t.xx + t.yy + t.zz;
        const double second = t.xx * t.yy - t.xy * t.xy + t.yy * t.zz - t.yz * t.yz + t.zz * t.xx - t.xz * t.xz;
        const double third = t.xx * (t.yy * t.zz - t.yz * t.yz) - t.xy * (t.xy * t.zz - t.yz * t.xz) +
                             t.xz * (t.xy * t.yz - t.yy * t.xz);
        constexpr double distinct = 0.05; // sin^2 of 13 degrees between normals
        if (!(first > 0)) continue;
        rank[v] = 1;
        if (second > distinct * first * first) rank[v] = third > distinct * second * first ? 3 : 2;
    }
    return rank;
}

} // namespace taut::impl
