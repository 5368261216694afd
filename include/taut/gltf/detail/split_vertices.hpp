// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <taut/core/types.hpp>
#include <taut/gltf/detail/primitives.hpp>

namespace taut::io::detail
{

using gltf_texcoord = std::array<float, 2>;

/// A vertex for each texture coordinate that the corners at a vertex of glTF have.
struct gltf_split
{
    struct pool
    {
        std::vector<gltf_texcoord> uv;      ///< of all vertices, old and new ones
        std::vector<std::uint32_t> origins; ///< the old vertex of each new one
    };
    std::vector<pool> pools;
    std::vector<std::array<std::uint32_t, 3>> corners; ///< the vertex in its pool at each corner of the triangles
};

inline gltf_texcoord to_gltf(const vec2& uv)
{
    const auto narrow = [](double x) { return x == 0 ? 0.0f : static_cast<float>(x); }; // 0 and -0 are one
    return {narrow(uv.x), narrow(1 - uv.y)};
}

/// vertices: of glTF, at each corner of the triangles; new ones are numbered in the order of the triangles
inline gltf_split split_vertices(const gltf_primitives& primitives, std::span<const std::array<idx, 3>> vertices,
                                 std::span<const std::array<vec2, 3>> corner_uv)
{
    constexpr std::uint32_t none = UINT32_MAX;
    gltf_split result;
    result.corners.resize(vertices.size());
    std::vector<std::vector<std::uint32_t>> next; // of a vertex that is there for another texture coordinate
    std::vector<std::vector<char>> used;
    for (std::size_t p = 0; p + 1 < primitives.first_vertex.size(); ++p)
    {
        result.pools.push_back({std::vector<gltf_texcoord>(primitives.vertices_of(p)), {}});
        next.emplace_back(primitives.vertices_of(p), none);
        used.emplace_back(primitives.vertices_of(p), char(0));
    }
    for (const gltf_primitive& p : primitives.all)
        for (std::size_t c = p.first; c < p.first + p.count; ++c)
            for (std::size_t k = 0; k < 3; ++k)
            {
                auto& [uv, origins] = result.pools[p.pool];
                const auto old = static_cast<std::uint32_t>(static_cast<std::size_t>(vertices[c][k]) -
                                                            primitives.first_vertex[p.pool]);
                std::uint32_t& v = result.corners[c][k] = old;
                const gltf_texcoord x = to_gltf(corner_uv[c][k]);
                if (!std::isfinite(x[0]) || !std::isfinite(x[1])) continue;
                while (used[p.pool][v] && uv[v] != x && next[p.pool][v] != none) v = next[p.pool][v];
                if (used[p.pool][v] && uv[v] != x)
                {
                    v = next[p.pool][v] = static_cast<std::uint32_t>(uv.size());
                    origins.push_back(old);
                    uv.push_back(x);
                    next[p.pool].push_back(none);
                    used[p.pool].push_back(1);
                }
                uv[v] = x;
                used[p.pool][v] = 1;
            }
    return result;
}

} // namespace taut::io::detail
