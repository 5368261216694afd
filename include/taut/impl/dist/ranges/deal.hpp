// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <taut/impl/dist/processes/communicator.hpp>
#include <taut/impl/files/volume/volume_file.hpp>
#include <taut/mesh_piece.hpp>
#include <taut/volume_file.hpp>

namespace taut::dist::impl
{

/// Deals out a mesh that the first process has: equal ranges of vertices, whose ids are their numbers there, and of
/// cells. Collective. m: of that process; others give null. parts: what is said of its simplices where these are parts
/// of other cells; those of one stay together.
template <class Element>
mesh_piece<Element> dealt(const communicator& all, const mesh<Element>* m,
                          const io::impl::corner_simplices<Element>* parts = nullptr)
{
    struct part_data
    {
        std::int64_t owner;
        double weight;
        mat<Element::dimension> edges;
    };
    parcels<part_data> data(all.ranks());
    using ids = std::array<std::int64_t, static_cast<std::size_t>(Element::corners)>;
    struct numbered
    {
        std::int64_t id;
        vec3 x;
    };
    parcels<numbered> vertices(all.ranks());
    parcels<ids> cells(all.ranks());
    all.together(
        [&]
        {
            if (!m) return;
            const std::size_t n = m->points().size(), c = m->cells().size(), P = all.ranks();
            const auto cut = [&](std::size_t r)
            {
                std::size_t k = c * r / P;
                if (parts)
                    while (k > 0 && k < c && parts->cells[k] == parts->cells[k - 1]) ++k;
                return k;
            };
            for (std::size_t r = 0; r < P; ++r)
            {
                for (std::size_t v = n * r / P; v < n * (r + 1) / P; ++v)
                    vertices[r].push_back({static_cast<std::int64_t>(v), m->points()[v]});
                for (std::size_t k = cut(r); k < cut(r + 1); ++k)
                {
                    if (parts) data[r].push_back({parts->cells[k], parts->weights[k], parts->regular[k]});
                    ids cell;
                    std::copy(m->cells()[k].begin(), m->cells()[k].end(), cell.begin());
                    cells[r].push_back(cell);
                }
            }
        });
    mesh_piece<Element> piece;
    for (const auto& v : all.exchange(vertices).items)
    {
        piece.ids.push_back(v.id);
        piece.points.push_back(v.x);
    }
    piece.cells = all.exchange(cells).items;
    for (const auto& d : all.exchange(data).items)
    {
        piece.owners.push_back(d.owner);
        piece.weights.push_back(d.weight);
        piece.edges.push_back(d.edges);
    }
    return piece;
}

/// Values of the vertices of pieces made by dealt(), in the order of the mesh, at the first process; empty elsewhere.
/// Collective.
template <class T>
std::vector<T> collected(const communicator& all, const std::vector<T>& x)
{
    parcels<T> to(all.ranks());
    to.front() = x;
    return all.exchange(to).items; // ranges ascend with the processes
}

/// The way back: values of the mesh at the vertices of the pieces. x: at the first process, one a vertex, or none.
/// Collective.
template <class T>
std::vector<T> spread(const communicator& all, const std::vector<T>& x)
{
    parcels<T> to(all.ranks());
    for (std::size_t r = 0, P = all.ranks(); r < P && !x.empty(); ++r)
        to[r].assign(x.begin() + static_cast<std::ptrdiff_t>(x.size() * r / P),
                     x.begin() + static_cast<std::ptrdiff_t>(x.size() * (r + 1) / P));
    return all.exchange(to).items;
}

} // namespace taut::dist::impl
