// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/files/gltf/primitives.hpp>
#include <taut/types.hpp>

namespace taut::io::impl
{

/// As a file holds it.
using gltf_texcoord = std::array<double, 2>;

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

/// The vertices of a pool, to which others are added.
class gltf_vertices
{
public:
    explicit gltf_vertices(std::size_t count) : pool_{std::vector<gltf_texcoord>(count), {}}, used_(count, 0) {}

    /// The vertex with the attributes of an old one and this texture coordinate.
    std::uint32_t with(std::uint32_t old, const gltf_texcoord& x)
    {
        if (used_[old] != 0 && bits(pool_.uv[old]) != bits(x))
        {
            const auto [at, is_new] =
                more_.emplace(std::pair(old, bits(x)), static_cast<std::uint32_t>(pool_.uv.size()));
            if (is_new)
            {
                pool_.origins.push_back(old);
                pool_.uv.push_back(x);
            }
            return at->second;
        }
        pool_.uv[old] = x;
        used_[old] = 1;
        return old;
    }

    gltf_split::pool take() && { return std::move(pool_); }

private:
    using key = std::array<std::uint64_t, 2>;
    static key bits(const gltf_texcoord& x) { return std::bit_cast<key>(x); }

    gltf_split::pool pool_;
    std::vector<char> used_;
    std::map<std::pair<std::uint32_t, key>, std::uint32_t> more_; // than the first of each old one
};

/// vertices:  of glTF, at each corner of the triangles; new ones are numbered in the order of the triangles
/// corner_uv: as the file holds them. A triangle without, whose corners are not all finite, lies in one point, the
///            corner of the square, where it covers nothing
inline gltf_split split_vertices(const gltf_primitives& primitives, std::span<const std::array<idx, 3>> vertices,
                                 std::span<const std::array<gltf_texcoord, 3>> corner_uv)
{
    gltf_split result;
    result.corners.resize(vertices.size());
    std::vector<gltf_vertices> pools;
    for (std::size_t p = 0; p + 1 < primitives.first_vertex.size(); ++p) pools.emplace_back(primitives.vertices_of(p));
    const auto is_finite = [](const gltf_texcoord& x) { return std::isfinite(x[0]) && std::isfinite(x[1]); };
    for (const gltf_primitive& p : primitives.all)
        for (std::size_t c = p.first; c < p.first + p.count; ++c)
        {
            const bool placed = std::all_of(corner_uv[c].begin(), corner_uv[c].end(), is_finite);
            for (std::size_t k = 0; k < 3; ++k)
            {
                const auto old = static_cast<std::uint32_t>(static_cast<std::size_t>(vertices[c][k]) -
                                                            primitives.first_vertex[p.pool]);
                result.corners[c][k] = pools[p.pool].with(old, placed ? corner_uv[c][k] : gltf_texcoord{0, 0});
            }
        }
    for (gltf_vertices& pool : pools) result.pools.push_back(std::move(pool).take());
    return result;
}

} // namespace taut::io::impl
