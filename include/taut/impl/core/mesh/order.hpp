// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// A renumbering and its inverse.
struct permutation
{
    std::vector<idx> new_to_old; ///< new_to_old[i] is the old number of what is now i
    std::vector<idx> old_to_new;

    explicit permutation(std::vector<idx> from = {}) : new_to_old(std::move(from)), old_to_new(new_to_old.size())
    {
        parallel_for(new_to_old.size(),
                     [this](std::size_t begin, std::size_t end)
                     {
                         for (std::size_t i = begin; i < end; ++i)
                             old_to_new[static_cast<std::size_t>(new_to_old[i])] = static_cast<idx>(i);
                     });
    }

    /// Identity renumbering of n things.
    static permutation identity(std::size_t n)
    {
        permutation p;
        p.new_to_old.resize(n);
        std::iota(p.new_to_old.begin(), p.new_to_old.end(), idx(0));
        p.old_to_new = p.new_to_old;
        return p;
    }

    /// Values in the new order, from values in the old one.
    template <class T>
    std::vector<T> apply(const std::vector<T>& old_values) const
    {
        return pick(old_values, new_to_old);
    }
    /// Values in the old order again, from values in the new one.
    template <class T>
    std::vector<T> undo(const std::vector<T>& new_values) const
    {
        return pick(new_values, old_to_new);
    }

private:
    template <class T>
    static std::vector<T> pick(const std::vector<T>& values, const std::vector<idx>& from)
    {
        std::vector<T> r(from.size());
        parallel_for(r.size(),
                     [&](std::size_t begin, std::size_t end)
                     {
                         for (std::size_t i = begin; i < end; ++i) r[i] = values[static_cast<std::size_t>(from[i])];
                     });
        return r;
    }
};

/// A renumbering of a mesh.
struct mesh_order
{
    permutation vertices, cells;
};

/// Identity renumbering.
template <class Element>
mesh_order identity_order(const mesh<Element>& m)
{
    return {permutation::identity(m.points().size()), permutation::identity(m.cells().size())};
}

/// Morton code of a point of the cube [0, 2^21)^3: the bits of its coordinates, interleaved.
inline std::uint64_t morton(const vec3& p)
{
    // Spreads the 21 low bits to every third place, halving the distance that groups move each time.
    const auto spread = [](double coordinate)
    {
        auto x = static_cast<std::uint64_t>(coordinate);
        x = (x | x << 32) & 0x001f00000000ffff;
        x = (x | x << 16) & 0x001f0000ff0000ff;
        x = (x | x << 8) & 0x100f00f00f00f00f;
        x = (x | x << 4) & 0x10c30c30c30c30c3;
        return (x | x << 2) & 0x1249249249249249;
    };
    return spread(p.x) << 2 | spread(p.y) << 1 | spread(p.z);
}

/// Vertices along the Morton curve of their rest positions.
std::vector<idx> along_curve(const std::vector<vec3>& points);

/// Computes an order in which neighbours in space are neighbours in memory: vertices along a Morton curve, cells by
/// their smallest vertex. On scans this reads 2 to 5 times fewer cache lines than the order of the file, as few as a
/// breadth-first or Hilbert order, and needs no connectivity. O(n log n).
template <class Element>
mesh_order locality_order(const mesh<Element>& m)
{
    mesh_order order{permutation(impl::along_curve(m.points())), permutation()};
    std::vector<idx> smallest(m.cells().size()), cells(m.cells().size());
    parallel_for(smallest.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t c = begin; c < end; ++c)
                     {
                         idx least = m.vertex_count();
                         for (const idx v : m.cells()[c])
                             least = std::min(least, order.vertices.old_to_new[static_cast<std::size_t>(v)]);
                         smallest[c] = least;
                     }
                 });
    impl::counting_sort(
        cells.size(), m.points().size(), [&](std::size_t c) { return smallest[c]; },
        [&](std::size_t c, std::size_t position) { cells[position] = static_cast<idx>(c); });
    order.cells = permutation(std::move(cells));
    return order;
}

/// A locality order with the vertices that move first and the pinned ones, in their own locality order, last.
struct solution_order
{
    mesh_order order;
    idx free_count = 0; ///< vertices [0, free_count) of the new order move, the rest are pinned

    /// pinned: one flag per vertex of the mesh, or empty.
    template <class Element>
    explicit solution_order(const mesh<Element>& m, const std::vector<bool>& pinned = {});
};

template <class Element>
solution_order::solution_order(const mesh<Element>& m, const std::vector<bool>& pinned)
    : order(locality_order(m)), free_count(m.vertex_count())
{
    if (pinned.empty()) return;
    auto numbers = std::move(order.vertices.new_to_old);
    const auto first_pinned = std::stable_partition(numbers.begin(), numbers.end(),
                                                    [&](idx old) { return !pinned[static_cast<std::size_t>(old)]; });
    free_count = static_cast<idx>(first_pinned - numbers.begin());
    order.vertices = permutation(std::move(numbers));
}

/// The mesh renumbered. The corners of each cell keep their order.
template <class Element>
mesh<Element> permute(const mesh<Element>& m, const mesh_order& order)
{
    std::vector<typename mesh<Element>::cell> cells(m.cells().size());
    parallel_for(cells.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t c = begin; c < end; ++c)
                     {
                         cells[c] = m.cells()[static_cast<std::size_t>(order.cells.new_to_old[c])];
                         for (idx& v : cells[c]) v = order.vertices.old_to_new[static_cast<std::size_t>(v)];
                     }
                 });
    return {order.vertices.apply(m.points()), std::move(cells)};
}

// Compiled once, with the bodies.
extern template mesh_order locality_order(const mesh<triangle>&);
extern template solution_order::solution_order(const mesh<triangle>&, const std::vector<bool>&);
extern template mesh<triangle> permute(const mesh<triangle>&, const mesh_order&);
extern template mesh_order locality_order(const mesh<tetrahedron>&);
extern template solution_order::solution_order(const mesh<tetrahedron>&, const std::vector<bool>&);
extern template mesh<tetrahedron> permute(const mesh<tetrahedron>&, const mesh_order&);

} // namespace taut::impl
