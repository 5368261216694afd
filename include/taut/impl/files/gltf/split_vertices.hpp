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
#include <tuple>
#include <utility>
#include <vector>

#include <taut/impl/files/gltf/primitives.hpp>
#include <taut/types.hpp>

namespace taut::io::impl
{

/// As a file holds it.
using gltf_texcoord = std::array<double, 2>;

/// A vertex for each texture coordinate that the corners at a vertex of glTF have; twins, which share vertices, have
/// one each.
struct gltf_split
{
    struct pool
    {
        std::vector<std::vector<gltf_texcoord>> uv; ///< of each layer of twins: of all vertices, old and new ones
        std::vector<std::uint32_t> origins;         ///< the old vertex of each new one

        std::size_t vertices() const { return uv[0].size(); }
    };
    std::vector<pool> pools;
    std::vector<std::array<std::uint32_t, 3>> corners; ///< the vertex in its pool at each corner of the triangles
};

/// The vertices of a pool, to which others are added.
class gltf_vertices
{
public:
    gltf_vertices(std::size_t count, std::size_t layers)
        : count_(count),
          pool_{std::vector(layers, std::vector<gltf_texcoord>(count)), {}},
          used_(layers, std::vector<char>(count, 0))
    {
    }

    /// The vertex that has what v has, which the layers before this one gave, and this texture coordinate.
    std::uint32_t with(std::uint32_t v, std::size_t layer, const gltf_texcoord& x)
    {
        gltf_texcoord& own = pool_.uv[layer][v];
        if (used_[layer][v] != 0 && bits(own) != bits(x))
        {
            const auto [at, is_new] =
                more_.emplace(std::tuple(v, layer, bits(x)), static_cast<std::uint32_t>(pool_.vertices()));
            if (is_new) add(v, layer, x);
            return at->second;
        }
        own = x;
        used_[layer][v] = 1;
        return v;
    }

    gltf_split::pool take() && { return std::move(pool_); }

private:
    using key = std::array<std::uint64_t, 2>;
    static key bits(const gltf_texcoord& x) { return std::bit_cast<key>(x); }

    void add(std::uint32_t v, std::size_t layer, const gltf_texcoord& x)
    {
        pool_.origins.push_back(v < count_ ? v : pool_.origins[v - count_]);
        for (std::size_t l = 0; l < used_.size(); ++l)
        {
            const gltf_texcoord before = pool_.uv[l][v];
            pool_.uv[l].push_back(l < layer ? before : x);
            used_[l].push_back(l <= layer ? 1 : 0);
        }
    }

    std::size_t count_; // of old vertices
    gltf_split::pool pool_;
    std::vector<std::vector<char>> used_;                                       // of each layer
    std::map<std::tuple<std::uint32_t, std::size_t, key>, std::uint32_t> more_; // than the first of each
};

/// vertices:  of glTF, at each corner of the triangles; new ones are numbered in the order of the triangles
/// corner_uv: as the file holds them. A triangle without, whose corners are not all finite, lies in one point, the
///            corner of the square, where it covers nothing
inline gltf_split split_vertices(const gltf_primitives& primitives, std::span<const std::array<idx, 3>> vertices,
                                 std::span<const std::array<gltf_texcoord, 3>> corner_uv)
{
    gltf_split result;
    result.corners.resize(vertices.size());
    std::vector<std::size_t> layers(primitives.first_vertex.size() - 1, 1);
    std::map<const gltf_primitive*, std::vector<std::size_t>> firsts; // triangles of twins
    for (const gltf_primitive& p : primitives.all)
    {
        layers[p.pool] = std::max(layers[p.pool], p.layer + 1);
        if (!p.copy_of) firsts[&primitives.drawn_by(p)].push_back(p.first);
    }
    std::vector<gltf_vertices> pools;
    for (std::size_t p = 0; p < layers.size(); ++p) pools.emplace_back(primitives.vertices_of(p), layers[p]);
    const auto is_finite = [](const gltf_texcoord& x) { return std::isfinite(x[0]) && std::isfinite(x[1]); };
    for (const gltf_primitive& p : primitives.all)
    {
        if (p.twin_of || p.count == 0) continue;
        const auto& twins = firsts[&p];
        for (std::size_t t = 0; t < p.count; ++t)
            for (std::size_t k = 0; k < 3; ++k)
            {
                auto v = static_cast<std::uint32_t>(static_cast<std::size_t>(vertices[p.first + t][k]) -
                                                    primitives.first_vertex[p.pool]);
                for (std::size_t l = 0; l < layers[p.pool]; ++l) // the first one stands for those that are not there
                {
                    const auto& uv = corner_uv[(l < twins.size() ? twins[l] : p.first) + t];
                    const bool placed = std::all_of(uv.begin(), uv.end(), is_finite);
                    v = pools[p.pool].with(v, l, placed ? uv[k] : gltf_texcoord{0, 0});
                }
                result.corners[p.first + t][k] = v;
            }
    }
    for (gltf_vertices& pool : pools) result.pools.push_back(std::move(pool).take());
    return result;
}

} // namespace taut::io::impl
